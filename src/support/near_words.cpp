#include "posewright/support/near_words.hpp"

#include <algorithm>
#include <cctype>

#include "posewright/support/text.hpp"

namespace posewright {
namespace {

// Longer texts are not misspelt names.
constexpr std::size_t longest_word = 100;

std::string plain(std::string_view word) {
  std::string result;
  for (const char c : word) result += c == '_' ? '-' : char(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> before(width), last(width), row(width);
  for (std::size_t j = 0; j < width; ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j < width; ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::string nearest_word(std::string_view written, const std::vector<std::string>& words) {
  if (written.size() > longest_word) return {};
  const std::string wanted = plain(written);
  const std::size_t most = std::min<std::size_t>(3, written.size() / 3);
  std::size_t best = most + 1;
  std::string nearest;
  for (const std::string& word : words) {
    if (word.size() > longest_word || word == written) continue;
    const std::size_t distance = edit_distance(wanted, plain(word));
    if (distance == best && word != nearest) nearest.clear();
    if (distance < best) best = distance, nearest = word;
  }
  return best <= most ? nearest : std::string();
}

std::string meant_instead(std::string_view written, const std::vector<std::string>& words) {
  const std::string word = nearest_word(written, words);
  return word.empty() ? word : " (did you mean " + in_quotes(word) + "?)";
}

}  // namespace posewright
