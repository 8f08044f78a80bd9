// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/baseline.h"

#include "base/error.h"
#include "survey/correct/slow_light.h"

#include <cmath>

namespace aphotic {

int BaselineCorrector::bin_of(double altitude_m) const {
    return needs_altitude() ? static_cast<int>(std::lround(altitude_m / options_.bin_m)) : 0;
}

void BaselineCorrector::learn_exponentials(const RawImage& image, double altitude_m) {
    const std::vector<SitePlane> planes = site_planes(image);
    for (std::size_t site = 0; site < planes.size(); ++site) {
        const std::vector<float>& samples = planes[site].samples;
        if (exponentials_.size() == site)
            exponentials_.emplace_back(samples.size(), options_.bin_m);
        AltitudeExponential& exponential = exponentials_[site];
        if (ended_passes_ == 0)
            exponential.learn_level(samples, altitude_m);
        else
            exponential.learn_spread(samples, altitude_m);
    }
    if (ended_passes_ == 0) ++learned_;
}

void BaselineCorrector::end_pass(std::size_t threads) {
    for (AltitudeExponential& exponential : exponentials_) {
        if (ended_passes_ == 0)
            exponential.fit(threads);
        else
            exponential.end();
    }
    ++ended_passes_;
}

void BaselineCorrector::learn(const RawImage& image, double altitude_m) {
    if (baseline_ == Baseline::AltitudeExponential) {
        learn_exponentials(image, altitude_m);
        return;
    }
    Surfaces& surfaces = bins_[bin_of(altitude_m)];
    const std::vector<SitePlane> planes = site_planes(image);
    for (std::size_t site = 0; site < planes.size(); ++site) {
        const SitePlane& plane = planes[site];
        if (surfaces.size() == site)
            surfaces.emplace_back(plane.width_px, plane.height_px, options_.order);
        surfaces[site].add(baseline_ == Baseline::LogPolynomial ? logarithms(plane.samples)
                                                                : plane.samples);
    }
}

std::size_t BaselineCorrector::learned(double altitude_m) const {
    if (baseline_ == Baseline::AltitudeExponential) return learned_;
    const auto bin = bins_.find(bin_of(altitude_m));
    return bin == bins_.end() ? 0 : bin->second.front().planes();
}

double BaselineCorrector::survey_mean(std::size_t site) const {
    double sum = 0.0;
    double planes = 0.0;
    for (const auto& [bin, surfaces] : bins_) {
        const auto count = static_cast<double>(surfaces[site].planes());
        sum += count * surfaces[site].mean();
        planes += count;
    }
    return sum / planes;
}

std::vector<float> BaselineCorrector::without_pattern(const std::vector<float>& plane,
                                                      std::size_t site,
                                                      int bin) const {
    const PolynomialSurface& surface = bins_.at(bin)[site];
    const std::vector<float> fitted = surface.fitted();
    if (baseline_ == Baseline::LogPolynomial)
        return divided_by_pattern(plane, exponentials(fitted));
    std::vector<float> level = divided_by_pattern(plane, fitted);
    if (!(surface.mean() > 0.0)) return level;  // a black bin stays black
    const double gain = survey_mean(site) / surface.mean();
    for (float& sample : level) sample = static_cast<float>(sample * gain);
    return level;
}

RawImage BaselineCorrector::corrected(const RawImage& image, double altitude_m) const {
    if (learns() && learned(altitude_m) == 0) {
        throw InputError("nothing was learned at an altitude of {:.2f} m", altitude_m);
    }
    std::vector<SitePlane> planes = site_planes(image);
    for (std::size_t site = 0; site < planes.size(); ++site) {
        SitePlane& plane = planes[site];
        const double sigma_px = options_.sigma * plane.width_px;
        switch (baseline_) {
            case Baseline::IlluminationReflectance:
                plane.samples = illumination_reflectance(plane.samples, plane.width_px, sigma_px);
                break;
            case Baseline::LocalEqualisation:
                plane.samples = locally_equalised(plane.samples,
                                                  plane.width_px,
                                                  {.tiles = options_.tiles, .clip = options_.clip});
                break;
            case Baseline::Homomorphic:
                plane.samples =
                    homomorphic(plane.samples,
                                plane.width_px,
                                {.sigma_px = sigma_px, .low = options_.low, .high = options_.high});
                break;
            case Baseline::LogPolynomial:
            case Baseline::BinnedPolynomial:
                plane.samples = without_pattern(plane.samples, site, bin_of(altitude_m));
                break;
            case Baseline::AltitudeExponential:
                plane.samples = exponentials_[site].corrected(plane.samples, altitude_m);
                break;
        }
    }
    RawImage result = image;
    put_site_planes(planes, result);
    return result;
}

}  // namespace aphotic
