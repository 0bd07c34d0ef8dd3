#include "reading.hpp"

#include <algorithm>
#include <cmath>

namespace posewright::programs {
namespace {

using Kind = Expression::Kind;

bool among(const std::vector<std::string_view>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

const Motion* Collector::motion(std::string_view word) const {
  const std::string wanted = grammar_.capitals ? upper(word) : std::string(word);
  const auto at = std::ranges::find_if(grammar_.motions, [&](const Motion& m) { return among(m.words, wanted); });
  return at == grammar_.motions.end() ? nullptr : &*at;
}

void Collector::move(const Motion& motion, std::string_view word, const std::vector<Expression>& arguments, int line) {
  Use use{line, std::string(word), motion.role};
  use.frames = frames;
  use.straight = grammar_.is_straight != nullptr && grammar_.is_straight(upper(word));
  if (motion.role == Role::other) {
    use.why = motion.why;
    reading.uses.push_back(use);
    return;
  }
  for (std::size_t i = motion.first; i < motion.first + motion.count; ++i)
    target(motion, i < arguments.size() ? arguments[i] : Expression{}, use);
}

void Collector::target(const Motion& motion, const Expression& to, Use use) {
  const std::string word = grammar_.capitals ? upper(to.word) : to.word;
  const auto unclear = [&](const std::string& why) {
    use.role = Role::unclear;
    use.why = why;
  };
  if (among(grammar_.standing, word)) {
    use.role = Role::standing;
  } else if (to.is(Kind::name)) {
    use.name = to.word;
    if (to.items.size() == 1 && to.items[0].is(Kind::constant))
      use.index = std::lround(std::clamp(to.items[0].value, -1e9, 1e9));
    if (to.component) unclear("moves to a part of " + to.word);
  } else if (to.is(Kind::list) || to.word == "p") {
    auto point = grammar_.as_point(to, source_);
    if (!point) point = FoundPoint{to.line, "", FoundPoint::Form::unclear, {}, "has values that are not understood"};
    use.point = reading.points.size();
    reading.points.push_back(*point);
  } else if (to.is(Kind::call) && !among(grammar_.offsets, word)) {
    unclear(to.word + "() computes its point");
  } else {
    const std::size_t before = reading.uses.size();
    use.role = motion.role == Role::step ? Role::step : Role::offset;
    names_in(to, use, 0);
    if (reading.uses.size() > before) use.why = reading.uses[before].name;
    else unclear("its point is not understood");
  }
  reading.uses.push_back(use);
}

void Collector::names_in(const Expression& expression, const Use& use, int depth) {
  if (expression.is(Kind::name)) {
    Use one = use;
    one.name = expression.word;
    one.moves = false;
    reading.uses.push_back(one);
  }
  if (depth < 40)
    for (const Expression& item : expression.items) names_in(item, use, depth + 1);
}

bool Collector::define(std::string_view name, const Expression& value, int line) {
  if (!value.is(Kind::list) && value.word != "p") return false;
  if (auto point = grammar_.as_point(value, source_)) {
    point->name = name;
    point->line = line;
    reading.points.push_back(*point);
    return true;
  }
  const std::size_t before = reading.points.size();
  for (const Expression& item : value.items)
    if (item.is(Kind::list) || item.word == "p")
      if (auto point = grammar_.as_point(item, source_)) {
        point->name = name;
        point->line = item.line;
        point->index = grammar_.first_index + long(reading.points.size() - before);
        reading.points.push_back(*point);
      }
  return reading.points.size() > before;
}

void Collector::change(std::string_view name, int line, const std::string& by) {
  reading.uses.push_back({line, by, Role::changed, std::string(name)});
}

void Collector::pass(const std::string& procedure, const std::vector<Expression>& arguments, int line, Role role) {
  for (const Expression& argument : arguments) {
    Use use{line, procedure, role};
    if (argument.is(Kind::name) && !argument.component) {
      use.name = argument.word;
      reading.uses.push_back(use);
    } else if (argument.is(Kind::list) && role == Role::passed) {
      if (const auto point = grammar_.as_point(argument, source_)) {
        use.point = reading.points.size();
        reading.points.push_back(*point);
        reading.uses.push_back(use);
      }
    }
  }
}

void take_numbers(const Expression& list, const std::vector<std::string>& names, FoundPoint& point) {
  for (std::size_t i = 0; i < list.items.size() && i < names.size(); ++i) {
    const Expression& item = list.items[i];
    if (item.is(Kind::constant)) {
      point.axes.emplace_back(names[i], TextNumber{item.begin, item.end, item.value});
    } else {
      point.form = FoundPoint::Form::unclear;
      point.why = "has values that only the controller computes";
    }
  }
}

}  // namespace posewright::programs
