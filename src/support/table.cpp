#include "posewright/support/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

namespace posewright {
namespace {

std::atomic<TableLayout> layout_of_all{TableLayout::aligned};

std::size_t width(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & '\xc0') != '\x80'; }));
}

/// Display of a unit: factor of SI, and its name.
struct Shown {
  double factor;
  std::string suffix;
};

Shown shown_unit(const std::string& unit) {
  if (unit == "m") return {1e3, " mm"};
  if (unit == "rad") return {180 / std::numbers::pi, " deg"};
  if (unit == "rad/(N·m)") return {1e6, " µrad/(N·m)"};
  if (unit == "m/N") return {1e6, " µm/N"};
  if (unit == "N/m") return {1e-3, " N/mm"};
  if (unit == "N·m/rad") return {1e-3, " kN·m/rad"};
  if (unit == "1") return {1, ""};
  return {1, " " + unit};
}

/// Without the sign of a number that is zero to the digits shown.
std::string unsigned_zero(std::string number) {
  if (number.starts_with('-') && number.find_first_not_of("-0.") == std::string::npos) number.erase(0, 1);
  return number;
}

}  // namespace

std::string counted(long count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string percent(double share) { return fmt::format("{:.2f} %", std::floor(share * 1e4) / 100); }

std::string proved_percent(double share) { return fmt::format("{:.1f} %", std::floor(share * 1e3) / 10); }

std::string searched_percent(double share) {
  return fmt::format("{:.0f} %", std::min(100.0, std::floor(share * 1e2 + 0.05)));
}

std::string at_most_percent(double share) { return fmt::format("{:.1f} %", std::ceil(share * 1e3) / 10); }

Table::Table(std::vector<std::string> header, std::string align) : align_(std::move(align)) {
  align_.resize(header.size(), align_.back());
  rows_.push_back(std::move(header));
}

void Table::row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

void set_table_layout(TableLayout layout) { layout_of_all = layout; }

std::string Table::text() const { return layout_of_all == TableLayout::markdown ? markdown() : aligned(); }

std::string Table::markdown() const {
  std::string text;
  for (const auto& row : rows_) {
    text += text.empty() ? "\n|" : "|";
    for (std::size_t c = 0; c < align_.size(); ++c) {
      text += ' ';
      for (const char letter : c < row.size() ? row[c] : std::string())
        text += letter == '|' ? "\\|" : std::string(1, letter);
      text += " |";
    }
    text += '\n';
    if (&row != &rows_.front()) continue;
    text += '|';
    for (const char align : align_) text += align == 'l' ? " --- |" : " ---: |";
    text += '\n';
  }
  return text + '\n';
}

std::string Table::aligned() const {
  std::vector<std::size_t> widths(align_.size(), 0);
  for (const auto& row : rows_)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string pad(widths[c] - width(row[c]), ' ');
      line += "  " + (align_[c] == 'l' ? row[c] + pad : pad + row[c]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string shown_value(double value, const std::string& unit) {
  const Shown shown = shown_unit(unit);
  return fmt::format("{:.4g}{}", value * shown.factor, shown.suffix);
}

std::string shown_to(double value, double resolution, const std::string& unit) {
  const Shown shown = shown_unit(unit);
  const double step = std::abs(resolution * shown.factor);
  if (!(step > 0) || !std::isfinite(step)) return shown_value(value, unit);
  const int decimals = std::clamp(1 - int(std::floor(std::log10(step))), 0, 12);
  return unsigned_zero(fmt::format("{:.{}f}", value * shown.factor, decimals)) + shown.suffix;
}

std::string seconds_text(double seconds) {
  return seconds < 120 ? fmt::format("{:.1f} s", seconds) : fmt::format("{:.1f} min", seconds / 60);
}

}  // namespace posewright
