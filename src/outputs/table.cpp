#include "posewright/outputs/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace posewright {
namespace {

std::size_t width(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & '\xc0') != '\x80'; }));
}

}  // namespace

Table::Table(std::vector<std::string> header, std::vector<Align> align) : align_(std::move(align)) {
  rows_.push_back(std::move(header));
}

void Table::row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

std::string Table::text() const {
  std::vector<std::size_t> widths(align_.size(), 0);
  for (const auto& row : rows_)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string pad(widths[c] - width(row[c]), ' ');
      line += "  " + (align_[c] == Align::left ? row[c] + pad : pad + row[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string shown_value(double value, const std::string& unit) {
  if (unit == "m") return fmt::format("{:.4g} mm", value * 1e3);
  if (unit == "rad") return fmt::format("{:.4g} deg", value * 180 / std::numbers::pi);
  if (unit == "rad/(N·m)") return fmt::format("{:.4g} µrad/(N·m)", value * 1e6);
  if (unit == "m/N") return fmt::format("{:.4g} µm/N", value * 1e6);
  if (unit == "N/m") return fmt::format("{:.4g} N/mm", value * 1e-3);
  if (unit == "N·m/rad") return fmt::format("{:.4g} kN·m/rad", value * 1e-3);
  if (unit == "1") return fmt::format("{:.4g}", value);
  return fmt::format("{:.4g} {}", value, unit);
}

}  // namespace posewright
