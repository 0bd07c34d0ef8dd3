#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace posewright {

/// Form of all tables of the process: aligned, or as Markdown (GitHub Flavored Markdown 4.10) with an empty
/// line before and after. A program sets it before it prints anything; the library never does.
enum class TableLayout { aligned, markdown };
void set_table_layout(TableLayout layout);

/// Aligned text table; widths count characters, not bytes, so that σ and µ line up.
class Table {
 public:
  /// @param align  l or r for left and right: one letter a column, the last one of all columns from there on
  explicit Table(std::vector<std::string> header, std::string align = "lr");
  void row(std::vector<std::string> cells);
  /// In the layout of the process.
  std::string text() const;

 private:
  std::string aligned() const;
  std::string markdown() const;

  std::vector<std::vector<std::string>> rows_;
  std::string align_;
};

/// "1 pose", "2 poses": nouns whose plural ends in s.
std::string counted(long count, std::string_view noun);

/// "97.86 %" for 0.97869: rounded down, because what is stated as reached must be.
std::string percent(double share);

/// "97 %": the same to the digits that a search gives on any processor. Half a thousandth is what the search stops at.
std::string searched_percent(double share);

/// "97.9 %" for 0.97869: rounded up, because no more is reached.
std::string at_most_percent(double share);
/// "98.5 %", rounded down: of a proof that rests on weights whose last digits depend on the processor.
std::string proved_percent(double share);

/// "0.0123 mm", "0.0045 deg": a value in SI for messages, by its SI unit ("m", "rad", "1").
std::string shown_value(double value, const std::string& unit);

/// "85.3 s", "12.0 min"
std::string seconds_text(double seconds);

/// Variant with decimals for two digits of `resolution` (a σ, in SI).
std::string shown_to(double value, double resolution, const std::string& unit);

}  // namespace posewright
