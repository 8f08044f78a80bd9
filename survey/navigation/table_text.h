// SPDX-License-Identifier: BSD-3-Clause
//
// A table as text, line by line and field by field, as loggers, databases and spreadsheets write
// it: RFC 4180 with any separator, and comments.
//
// Lines end in LF, CR LF or CR. A field in double quotes may contain separators, line ends, and
// quotes, which are doubled; quotes that do not close before a separator or a line end are ordinary
// characters. Blanks around a field are ignored. With blanks as separators, each word is a field.
//
// A line that begins with #, % or // is a comment, and so is everything from a line that begins
// with /* to the next */. So is one that begins with ;, unless semicolons separate the fields.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

inline constexpr char kByBlanks = ' ';
inline constexpr std::size_t kMostTableFields = 10000;  // of a line
inline constexpr std::size_t kMostFieldBytes = std::size_t{1} << 16U;

struct TextRow {
    std::size_t line = 0;  // the first of its lines
    std::vector<std::string> fields{};
    bool has_line_end = true;
};

class TableText {
  public:
    // name is for messages. The text must outlive this.
    TableText(std::string name, std::string_view text);

    // Advances to a line that is neither empty nor a comment; false if there is none. With a
    // separator of '\0', which means not yet known, a line that begins with ; is neither.
    bool find_row(char separator);

    // The row that begins here; take_row() also moves past it. An InputError if it has more than
    // kMostTableFields, or one of more than kMostFieldBytes.
    [[nodiscard]] TextRow row(char separator) const;
    TextRow take_row(char separator);

    // The last one-line comment that find_row() skipped, without its mark; numpy.savetxt puts the
    // header row there.
    [[nodiscard]] std::string_view last_comment() const { return last_comment_; }

    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] bool begins_with(std::string_view word) const;
    void pass_line();

  private:
    [[nodiscard]] bool is_at_line_end() const;
    void pass_line_end();
    void pass_to(std::size_t end);
    void pass_block_comment();
    [[nodiscard]] std::size_t closing_quote(std::size_t open, char separator) const;
    std::string take_field(char separator);

    std::string name_;
    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
    std::string_view last_comment_{};
};

}  // namespace aphotic
