// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/table_text.h"

#include "base/csv.h"
#include "base/error.h"

#include <algorithm>
#include <utility>

namespace aphotic {
namespace {

constexpr std::string_view kSpaceAndTab = " \t";

// The characters that end a field.
std::string stops_of(char separator) {
    std::string stops = "\r\n";
    stops += separator == kByBlanks ? std::string(kSpaceAndTab) : std::string(1, separator);
    return stops;
}

// The characters allowed between a quote and the field's end.
std::string_view padding_of(char separator) {
    if (separator == kByBlanks) return {};
    return separator == '\t' ? " " : kSpaceAndTab;
}

std::string with_single_quotes(std::string_view quoted) {
    std::string text;
    for (std::size_t i = 0; i < quoted.size(); ++i) {
        text += quoted[i];
        if (quoted[i] == '"') ++i;
    }
    return text;
}

}  // namespace

TableText::TableText(std::string name, std::string_view text)
    : name_(std::move(name)), text_(without_byte_order_mark(text)) {}

bool TableText::is_at_line_end() const {
    return at_ == text_.size() || text_[at_] == '\n' || text_[at_] == '\r';
}

void TableText::pass_line_end() {
    if (at_ == text_.size()) return;
    const bool is_pair = text_.substr(at_).starts_with("\r\n");
    at_ += is_pair ? 2 : 1;
    ++line_;
}

void TableText::pass_to(std::size_t end) {
    while (at_ < end) {
        if (is_at_line_end()) {
            pass_line_end();
        } else {
            ++at_;
        }
    }
}

void TableText::pass_line() {
    at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
    pass_line_end();
}

void TableText::pass_block_comment() {
    constexpr std::string_view kEnd = "*/";
    const std::size_t start = text_.find("/*", at_) + kEnd.size();
    const std::size_t end = text_.find(kEnd, start);
    if (end == std::string_view::npos)
        fail_at_line(name_, line_, "found a comment that begins with /* and has no */");
    pass_to(end + kEnd.size());
}

bool TableText::begins_with(std::string_view word) const {
    const std::size_t first = text_.find_first_not_of(kSpaceAndTab, at_);
    return first != std::string_view::npos && text_.substr(first).starts_with(word);
}

bool TableText::find_row(char separator) {
    const bool has_semicolon_comments = separator != '\0' && separator != ';';
    while (text_.find_first_not_of(" \t\r\n", at_) != std::string_view::npos) {
        if (begins_with("/*")) {
            pass_block_comment();
        } else if (begins_with("\n") || begins_with("\r")) {
            pass_line();
        } else if (begins_with("#") || begins_with("%") || begins_with("//") ||
                   (has_semicolon_comments && begins_with(";"))) {
            const std::size_t start = text_.find_first_not_of(" \t#%/;", at_);
            pass_line();
            last_comment_ = text_.substr(std::min(start, at_), at_ - std::min(start, at_));
        } else {
            return true;
        }
    }
    pass_to(text_.size());
    return false;
}

std::size_t TableText::closing_quote(std::size_t open, char separator) const {
    const std::size_t end = std::min(text_.size(), open + kMostFieldBytes);
    for (std::size_t at = open + 1; at < end; ++at) {
        if (text_[at] != '"') continue;
        if (text_.substr(at + 1).starts_with('"')) {
            ++at;
            continue;
        }
        const std::size_t next = text_.find_first_not_of(padding_of(separator), at + 1);
        const bool ends_field = next == std::string_view::npos ||
                                stops_of(separator).find(text_[next]) != std::string::npos;
        return ends_field ? at : std::string_view::npos;
    }
    return std::string_view::npos;
}

std::string TableText::take_field(char separator) {
    const std::size_t first = text_.find_first_not_of(padding_of(separator), at_);
    if (first != std::string_view::npos && text_[first] == '"') {
        const std::size_t close = closing_quote(first, separator);
        if (close != std::string_view::npos) {
            const std::string_view quoted = text_.substr(first + 1, close - first - 1);
            const std::size_t next = text_.find_first_not_of(padding_of(separator), close + 1);
            pass_to(std::min(next, text_.size()));
            return with_single_quotes(trimmed(quoted));
        }
    }
    const std::size_t start = at_;
    at_ = std::min(text_.find_first_of(stops_of(separator), at_), text_.size());
    if (at_ - start > kMostFieldBytes) {
        fail_at_line(name_,
                     line_,
                     "found a field of {} characters; allowed: up to {}",
                     at_ - start,
                     kMostFieldBytes);
    }
    return std::string(trimmed(text_.substr(start, at_ - start)));
}

TextRow TableText::take_row(char separator) {
    const bool is_of_words = separator == kByBlanks;
    TextRow row{.line = line_};
    for (bool goes_on = true; goes_on;) {
        if (is_of_words) at_ = std::min(text_.find_first_not_of(kSpaceAndTab, at_), text_.size());
        if (is_of_words && is_at_line_end()) break;
        row.fields.push_back(take_field(separator));
        if (row.fields.size() > kMostTableFields) {
            fail_at_line(name_, row.line, "found more than {} fields in a line", kMostTableFields);
        }
        goes_on = !is_at_line_end();
        if (goes_on) ++at_;
    }
    row.has_line_end = at_ < text_.size();
    pass_line_end();
    return row;
}

TextRow TableText::row(char separator) const {
    TableText here = *this;
    return here.take_row(separator);
}

}  // namespace aphotic
