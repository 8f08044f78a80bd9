// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/spline_import.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/printable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <utility>

namespace aphotic {
namespace {

constexpr std::array<std::string_view, 4> kSplineForms{
    "linear_spline", "cubic_spline", "natural_spline", "quadratic_spline"};
constexpr std::string_view kArraySize = "36";
constexpr double kArrayFirst_nm = 380.0;  // as in SpectralRender
constexpr double kArrayStep_nm = 10.0;
constexpr std::size_t kMaxVector = 5;   // the longest in POV-Ray
constexpr std::size_t kMostShown = 80;  // of a string, in a message
constexpr int kMaxDepth = 100;          // of nested brackets

constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kOfWords =
    "_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";

struct Token {
    enum class Kind { End, Number, Word, Symbol };
    Kind kind = Kind::End;
    std::string_view text{};
    std::size_t line = 0;
    double number = 0.0;
};

std::size_t comment_end(std::string_view text, std::size_t at) {
    int depth = 0;
    do {
        const bool opens = text.substr(at).starts_with("/*");
        const bool closes = text.substr(at).starts_with("*/");
        depth += opens ? 1 : closes ? -1 : 0;
        at += opens || closes ? 2 : 1;
    } while (depth > 0 && at < text.size());
    return depth > 0 ? std::string_view::npos : at;
}

std::size_t text_end(std::string_view text, std::size_t at) {
    for (++at; at < text.size() && text[at] != '"';) at += text[at] == '\\' ? 2 : 1;
    return at < text.size() ? at + 1 : std::string_view::npos;
}

// Replaces comments, which nest, and the contents of strings by blanks.
std::string without_comments(const std::string& file, std::string_view whole) {
    std::string text(without_byte_order_mark(whole));
    for (std::size_t at = 0; at < text.size();) {
        const bool is_text = text[at] == '"';
        const bool is_line = text.compare(at, 2, "//") == 0;
        if (!is_text && !is_line && text.compare(at, 2, "/*") != 0) {
            ++at;
            continue;
        }
        const std::size_t end = is_text   ? text_end(text, at)
                                : is_line ? std::min(text.find_first_of("\r\n", at), text.size())
                                          : comment_end(text, at);
        if (end == std::string::npos) {
            fail_at_line(file,
                         static_cast<std::size_t>(1 + std::ranges::count(text.substr(0, at), '\n')),
                         "the {} that begins here is not terminated",
                         is_text ? "text" : "comment");
        }
        for (at += is_text ? 1 : 0; at < end; ++at) {
            if (text[at] != '\n') text[at] = ' ';
        }
    }
    return text;
}

class Parser {
  public:
    Parser(const std::string& file, std::string_view text, const std::string& only)
        : file_(file), only_(only), text_(without_comments(file, text)), rest_(text_) {
        advance();
    }

    SplineFile read() {
        while (token_.kind != Token::Kind::End) {
            const std::size_t line = token_.line;
            if (take("#")) {
                if (take("declare") || take("local")) read_declaration();
            } else if (take("spline")) {
                if (take("{")) found_.anonymous_lines.push_back(line);
            } else {
                advance();
            }
        }
        if (found_.spectra.empty()) fail_for_want_of_spectra();
        return std::move(found_);
    }

  private:
    void advance() {
        const std::size_t blanks = std::min(rest_.find_first_not_of(" \t\r\n\f\v"), rest_.size());
        line_ += static_cast<std::size_t>(std::ranges::count(rest_.substr(0, blanks), '\n'));
        rest_.remove_prefix(blanks);
        token_ = {.line = line_};
        if (rest_.empty()) return;
        std::string_view behind = rest_;
        const std::size_t digit = rest_[0] == '.' ? 1 : 0;
        if (digit < rest_.size() && kDigits.find(rest_[digit]) != std::string_view::npos) {
            // A value out of range is not an error here: it may be in a part that is not read.
            token_.kind = Token::Kind::Number;
            token_.number = read_leading_number<double>(behind).value_or(
                std::numeric_limits<double>::quiet_NaN());
        } else {
            const std::size_t word = std::min(rest_.find_first_not_of(kOfWords), rest_.size());
            token_.kind = word > 0 ? Token::Kind::Word : Token::Kind::Symbol;
            behind.remove_prefix(std::max<std::size_t>(word, 1));
        }
        token_.text = rest_.substr(0, rest_.size() - behind.size());
        rest_ = behind;
    }

    bool take(std::string_view text) {
        if (token_.kind == Token::Kind::End || token_.text != text) return false;
        advance();
        return true;
    }

    template <typename... T>
    [[noreturn]] void fail(std::size_t line, fmt::format_string<T...> what, T&&... with) const {
        fail_at_line(file_, line, "{}: {}", where_, fmt::format(what, std::forward<T>(with)...));
    }

    [[noreturn]] void refuse(const std::string& allowed) const {
        const bool is_printable = token_.text.size() != 1 ||
                                  std::isprint(static_cast<unsigned char>(token_.text[0])) != 0;
        const std::string found =
            token_.kind == Token::Kind::End ? "the end of the file"
            : is_printable
                ? fmt::format("'{}'", printable(token_.text.substr(0, kMostShown)))
                : fmt::format("the byte 0x{:02X}", static_cast<unsigned char>(token_.text[0]));
        fail(token_.line, "found {}; allowed: {}", found, allowed);
    }

    [[noreturn]] void fail_for_want_of_spectra() const {
        const std::string fitting =
            only_ == "*" ? "" : fmt::format(", with a NAME that matches '{}'", only_);
        throw InputError(
            "{}: found no spectrum; allowed: #declare NAME = spline {{ ... }} or #declare NAME = "
            "array[36] {{ ... }}{}",
            file_,
            fitting);
    }

    void read_declaration() {
        SplineSpectrum spectrum;
        spectrum.identifier = token_.text;
        spectrum.line = token_.line;
        if (token_.kind != Token::Kind::Word) return;
        advance();
        if (!take("=")) return;
        const bool is_spline = take("spline") && take("{");
        if (!is_spline && !takes_array_head()) return;
        if (::fnmatch(only_.c_str(), spectrum.identifier.c_str(), 0) != 0) return;
        where_ = spectrum.identifier;
        is_spline ? read_spline(spectrum) : read_array(spectrum);
        add(std::move(spectrum));
    }

    bool takes_array_head() {
        return take("array") && take("[") && take(kArraySize) && take("]") && take("{");
    }

    void read_spline(SplineSpectrum& spectrum) {
        spectrum.form = kSplineForms.front();
        while (std::count(kSplineForms.begin(), kSplineForms.end(), token_.text) > 0) {
            spectrum.form = token_.text;
            advance();
        }
        while (!take("}")) {
            SplineKnot knot{.line = token_.line};
            knot.lambda_nm = sum(0);
            check_wavelength(knot);
            take(",");
            knot.value = value();
            take(",");
            spectrum.knots.push_back(knot);
        }
        sort_knots(spectrum);
    }

    void read_array(SplineSpectrum& spectrum) {
        spectrum.form = "array[36]";
        while (!take("}")) {
            const auto i = static_cast<double>(spectrum.knots.size());
            SplineKnot knot{.line = token_.line, .lambda_nm = kArrayFirst_nm + i * kArrayStep_nm};
            knot.value = value();
            take(",");
            spectrum.knots.push_back(knot);
        }
        if (fmt::format("{}", spectrum.knots.size()) != kArraySize) {
            fail(spectrum.line, "found {} values; allowed: {}", spectrum.knots.size(), kArraySize);
        }
    }

    void check_wavelength(const SplineKnot& knot) const {
        if (kSplineRange.contains(knot.lambda_nm)) return;
        fail(knot.line,
             "found the wavelength {}; allowed: {} to {}, in nm",
             knot.lambda_nm,
             kSplineRange.first_nm,
             kSplineRange.last_nm);
    }

    void sort_knots(SplineSpectrum& spectrum) const {
        auto& knots = spectrum.knots;
        if (knots.size() < 2) {
            fail(spectrum.line, "found {} knots; a curve needs 2 or more", knots.size());
        }
        std::ranges::stable_sort(knots, {}, &SplineKnot::lambda_nm);
        const auto twice =
            std::ranges::adjacent_find(knots, std::ranges::equal_to(), &SplineKnot::lambda_nm);
        if (twice == knots.end()) return;
        fail(std::next(twice)->line,
             "found a duplicate wavelength {}, first on line {}; allowed: once",
             twice->lambda_nm,
             twice->line);
    }

    // Two spectra may not go to one file, even on file systems that ignore case.
    void add(SplineSpectrum spectrum) {
        const std::string table = spline_table_name(spectrum.identifier);
        for (const SplineSpectrum& other : found_.spectra) {
            if (spline_table_name(other.identifier) != table) continue;
            fail(spectrum.line,
                 "found a second spectrum for {}, the first is {} on line {}; allowed: one",
                 table,
                 other.identifier,
                 other.line);
        }
        found_.spectra.push_back(std::move(spectrum));
    }

    double value() {
        const std::size_t line = token_.line;
        if (!take("<")) return finite(sum(0), line);
        std::vector<double> components;
        while (!take(">")) {
            components.push_back(finite(sum(0), line));
            take(",");
        }
        const bool unequal =
            std::ranges::adjacent_find(components, std::not_equal_to<>()) != components.end();
        if (unequal || components.size() < 2 || components.size() > kMaxVector) {
            fail(line,
                 "found <{}>; allowed: a number, or a vector of 2 to {} equal ones",
                 fmt::join(components, ", "),
                 kMaxVector);
        }
        return components.front();
    }

    [[nodiscard]] double finite(double number, std::size_t line) const {
        if (std::isfinite(number)) return number;
        fail(line, "found a number out of range; allowed: finite");
    }

    double sum(int depth) { return chain(true, depth); }

    // A chain of + and -, or of * and / within one.
    double chain(bool is_sum, int depth) {
        const auto next = [&] { return is_sum ? chain(false, depth) : factor(depth); };
        double result = next();
        for (;;) {
            if (take(is_sum ? "+" : "*")) {
                result = is_sum ? result + next() : result * next();
            } else if (take(is_sum ? "-" : "/")) {
                result = is_sum ? result - next() : result / next();
            } else {
                return result;
            }
        }
    }

    double factor(int depth) {
        double sign = 1.0;
        while (token_.text == "-" || token_.text == "+") {
            if (token_.text == "-") sign = -sign;
            advance();
        }
        if (depth < kMaxDepth && take("(")) {
            const double result = sum(depth + 1);
            if (!take(")")) refuse("')'");
            return sign * result;
        }
        if (token_.kind != Token::Kind::Number) {
            refuse("numbers, vectors of equal numbers, and + - * / ( ) between numbers");
        }
        const double result = token_.number;
        advance();
        return sign * result;
    }

    const std::string& file_;
    const std::string& only_;
    std::string text_;
    std::string_view rest_;  // of the text, after the token
    std::size_t line_ = 1;
    Token token_;
    std::string where_;  // the spectrum that is being read
    SplineFile found_;
};

bool is_lamp(CurveRole role) {
    return role == CurveRole::LampSpectrum;
}

void check_values(const std::string& file, const SplineSpectrum& spectrum, CurveRole role) {
    for (const SplineKnot& knot : spectrum.knots) {
        const bool fits = knot.value >= 0.0 && (is_lamp(role) || knot.value <= 1.0);
        if (fits) continue;
        fail_at_line(file,
                     knot.line,
                     "{}: found {} at {} nm; allowed for {}: {}",
                     spectrum.identifier,
                     knot.value,
                     knot.lambda_nm,
                     role_name(role),
                     is_lamp(role) ? "0 or more" : "0 to 1");
    }
}

std::string obtained_text(const SplineSpectrum& spectrum) {
    if (spectrum.form == "array[36]") {
        return "the values of an array[36], taken at 380 to 730 nm by 10 nm, as in SpectralRender";
    }
    std::string text = fmt::format("the knots of a {}", spectrum.form);
    if (!spectrum.is_linear()) text += ", joined here by straight lines, unlike POV-Ray's curve";
    return text;
}

}  // namespace

SplineFile parse_splines(const std::string& file_name,
                         std::string_view text,
                         const std::string& only) {
    return Parser(file_name, text, only).read();
}

std::string spline_table_name(const std::string& identifier) {
    std::string name;
    for (const char c : identifier) {
        const auto lower = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        if (c != '_') {
            name += lower;
        } else if (!name.empty()) {  // a name that begins with a dash looks like an option
            name += '-';
        }
    }
    return name + ".csv";
}

std::string spline_table(const std::string& file_name,
                         const SplineSpectrum& spectrum,
                         CurveRole role) {
    check_values(file_name, spectrum, role);
    std::string text = fmt::format("# title: {}\n", spectrum.identifier);
    text += fmt::format("# source: {}, line {}, #declare {}\n",
                        printable(std::filesystem::path(file_name).filename().string()),
                        spectrum.line,
                        spectrum.identifier);
    text += fmt::format("# obtained: {}\n", obtained_text(spectrum));
    text += is_lamp(role) ? "wavelength_nm,relative_power\n" : "wavelength_nm,reflectance\n";
    for (const SplineKnot& knot : spectrum.knots) {
        text += fmt::format("{},{}\n", knot.lambda_nm, knot.value);
    }
    // The file's name is untrusted input and becomes part of the table.
    const std::string table_name = spline_table_name(spectrum.identifier);
    static_cast<void>(curves_of(parse_table(table_name, text), role));
    return text;
}

}  // namespace aphotic
