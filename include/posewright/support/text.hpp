#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace posewright {

/// Bytes of the UTF-8 sequence at the front of `text`, which is not empty; 0 if it is malformed (RFC 3629: no overlong
/// form, no surrogate, at most U+10FFFF).
std::size_t utf8_length(std::string_view text);

/// Text for a message: in single quotes, control characters escaped and long text cut, so that a message keeps to
/// one short line whatever the file holds.
std::string in_quotes(std::string_view text);

/// Text as one line: control characters and bytes that are not UTF-8 escaped.
std::string one_line(std::string_view text);

/// True if `text` has a character that would break a table, a message or a name: controls and Unicode line breaks.
bool has_control_character(std::string_view text);

/// Without the blanks and tabs at both ends.
std::string_view trimmed_blanks(std::string_view text);

/// Finite numbers separated by blanks and line breaks; none if `text` holds anything else.
std::optional<std::vector<double>> numbers_in(std::string_view text);

}  // namespace posewright
