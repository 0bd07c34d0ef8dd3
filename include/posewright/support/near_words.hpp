#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace posewright {

/// Fewest letters that have to be put in, left out, replaced or exchanged with their neighbour to make one word of the
/// other (optimal string alignment distance; Boytsov 2011, "Indexing methods for approximate dictionary searching",
/// section 2.2). O(|a|·|b|).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word that somebody meant who wrote `written`: the nearest one, or one that differs by large letters or by - and
/// _ alone. Empty where none is near (at most a third of the letters wrong, no more than three) or where two are
/// equally near.
std::string nearest_word(std::string_view written, const std::vector<std::string>& words);

/// " (did you mean 'WORD'?)", or nothing.
std::string meant_instead(std::string_view written, const std::vector<std::string>& words);

}  // namespace posewright
