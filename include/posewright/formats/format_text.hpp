#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Numbers and names in exported files.
namespace posewright::formats {

double to_degrees(double radians);
/// deg for rad, mm for m.
double to_degrees_or_millimetres(double value, const std::string& unit);

/// Fixed decimals, never −0.000.
std::string fixed(double value, int decimals);
/// Variant without zeros at the end.
std::string short_fixed(double value, int decimals);
/// Fewest digits that read back bit-equal.
std::string shortest(double value);
/// Variant with a decimal point, so that every YAML reader takes it for a number (PyYAML takes 1e-07 for a text).
std::string yaml_number(double value);
/// [a, b, c]
std::string yaml_numbers(const std::vector<double>& values);
/// A name as YAML: quoted if a reader could take it for something else.
std::string yaml_text(const std::string& text);
std::string yaml_texts(const std::vector<std::string>& texts);

/// Printable ASCII: letters with marks become plain ones (ä: ae), anything else unknown '?'.
std::string ascii(std::string_view utf8);
/// Variant without characters that end texts and comments in robot programs, at most `limit` characters.
std::string program_text(std::string_view text, std::size_t limit);
std::string with_crlf(const std::string& text);
std::string xml_escaped(const std::string& text);
/// Quoted where it has a comma or a quote (RFC 4180).
std::string csv_cell(const std::string& text);
/// For a message: ASCII in quotes, cut.
std::string in_quotes(std::string_view text);

}  // namespace posewright::formats
