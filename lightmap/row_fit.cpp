// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/row_fit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {

namespace {

constexpr std::size_t kTerms = kFitDegree + 1;
constexpr double kMiddle = 0.5 * (kRowBlock - 1);

// From -1 to 1 over the block.
double place_of(std::size_t pixel) {
    return (static_cast<double>(pixel) - kMiddle) / kMiddle;
}

// Samples to the powers' coefficients, by the columns.
using FitMatrix = std::array<std::array<double, kTerms>, kFitSamples>;

// By Chebyshev's polynomials, which keep the digits, and of them into powers.
FitMatrix fit_matrix() {
    constexpr auto kRows = static_cast<Eigen::Index>(kFitSamples);
    constexpr auto kColumns = static_cast<Eigen::Index>(kTerms);
    Eigen::MatrixXd at_samples(kRows, kColumns);
    for (Eigen::Index i = 0; i < kRows; ++i) {
        const double angle = std::acos(place_of(fit_pixels()[static_cast<std::size_t>(i)]));
        for (Eigen::Index k = 0; k < kColumns; ++k) {
            at_samples(i, k) = std::cos(static_cast<double>(k) * angle);
        }
    }
    Eigen::MatrixXd powers = Eigen::MatrixXd::Zero(kColumns, kColumns);  // of T_k, by column
    powers(0, 0) = powers(1, 1) = 1.0;
    for (Eigen::Index k = 2; k < kColumns; ++k) {
        powers.col(k).tail(kColumns - 1) = 2.0 * powers.col(k - 1).head(kColumns - 1);
        powers.col(k) -= powers.col(k - 2);
    }
    const Eigen::MatrixXd solved =
        powers * at_samples.householderQr().solve(Eigen::MatrixXd::Identity(kRows, kRows));
    FitMatrix matrix;
    for (std::size_t i = 0; i < kFitSamples; ++i) {
        for (std::size_t k = 0; k < kTerms; ++k) {
            matrix[i][k] = solved(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i));
        }
    }
    return matrix;
}

APHOTIC_WIDE void evaluate(const std::array<double, kTerms>& powers, RowBlock<double>& values) {
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double x = (static_cast<double>(static_cast<int>(i)) - kMiddle) * (1.0 / kMiddle);
        double value = powers[kFitDegree];
        for (std::size_t k = kFitDegree; k-- > 0;) value = powers[k] + x * value;
        values[i] = value;
    }
}

}  // namespace

const std::array<std::size_t, kFitSamples>& fit_pixels() {
    static const std::array<std::size_t, kFitSamples> kPixels = [] {
        std::array<std::size_t, kFitSamples> found{};
        for (std::size_t k = 0; k < kFitSamples; ++k) {
            const double angle = std::numbers::pi * static_cast<double>(k) / (kFitSamples - 1);
            found[k] = static_cast<std::size_t>(std::lround(kMiddle * (1.0 - std::cos(angle))));
        }
        return found;
    }();
    return kPixels;
}

void take_samples(const DirectionBlock& V, bool has_sides, DirectionBlock& samples) {
    const auto& pixels = fit_pixels();
    samples.count = kFitSamples;
    for (std::size_t i = 0; i < kFitSamples; ++i) {
        samples.axis[i] = V.axis[pixels[i]];
        samples.square[i] = V.square[pixels[i]];
        if (!has_sides) continue;
        samples.along[i] = V.along[pixels[i]];
        samples.across[i] = V.across[pixels[i]];
    }
}

bool fit(const RowBlock<double>& samples,
         double absolute,
         double relative,
         RowBlock<double>& values) {
    static const FitMatrix kMatrix = fit_matrix();
    const auto& pixels = fit_pixels();
    std::array<double, kTerms> powers{};
    for (std::size_t i = 0; i < kFitSamples; ++i) {
        for (std::size_t k = 0; k < kTerms; ++k) powers[k] += kMatrix[i][k] * samples[i];
    }
    evaluate(powers, values);
    bool is_fit = true;
    for (std::size_t i = 0; i < kFitSamples; ++i) {
        const double off = std::abs(values[pixels[i]] - samples[i]);
        is_fit &= off <= absolute + relative * std::abs(samples[i]);
    }
    return is_fit;
}

bool fit(const float* samples, RowBlock<float>& values) {
    RowBlock<double> of_samples;
    RowBlock<double> of_block;
    for (std::size_t i = 0; i < kFitSamples; ++i) {
        if (!(samples[i] > 0.0F)) return false;
        of_samples[i] = static_cast<double>(samples[i]);
    }
    if (!fit(of_samples, 0.0, kRowFitError, of_block)) return false;
    std::ranges::transform(
        of_block, values.begin(), [](double value) { return static_cast<float>(value); });
    return true;
}

}  // namespace aphotic
