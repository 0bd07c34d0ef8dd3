#pragma once

#include <functional>
#include <string>

namespace posewright::cli {

/// True if stdin and stderr are terminals, so that questions make sense.
bool can_ask();

/// Asks on stderr until `take` accepts the answer, which is `standard` where nothing but Enter is typed. What `take`
/// throws as InputError is shown before the next try. Throws InputError where the input ends.
void ask(const std::string& question, const std::string& standard, const std::function<void(const std::string&)>& take);

}  // namespace posewright::cli
