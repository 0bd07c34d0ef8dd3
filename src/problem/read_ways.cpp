#include <algorithm>

#include "posewright/problem/ways.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"
#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Value;

/// Tips by their names, which become parts of names of parameters.
std::vector<TipSpec> read_tips(const Value& value) {
  std::vector<TipSpec> tips;
  for (const yaml::Entry& entry : Section(value).entries()) {
    if (entry.key.value.find_first_of("*?.@,;\"'[]#") != std::string::npos)
      entry.value.fail("is a tip with a name of other characters", "a name without any of * ? . @ , ; \" ' [ ] #");
    tips.push_back({entry.key.value, entry.value.exact_name()});
    tips.back().link.line = entry.value.line();
  }
  if (tips.empty()) value.fail("is empty", "at least one tip is needed");
  return tips;
}

class WaysReader {
 public:
  WaysReader(const Section& root, const Section& robot, const Value& tips, Problem& problem)
      : root_(root),
        robot_(robot),
        problem_(problem),
        arm_(std::get<SerialArmSpec>(problem.robot)),
        tips_(read_tips(tips)),
        used_(tips_.size(), 0) {
    for (const TipSpec& tip : tips_) names_.push_back(tip.name);
  }

  void read() {
    for_each_instrument(problem_.measurement, [this](MeasurementSpec& instrument) { add_way(instrument); });
    for (std::size_t t = 0; t < tips_.size(); ++t)
      if (used_[t] == 0)
        throw InputError(problem_.at(tips_[t].link.line),
                         "robot.tips: no instrument sees or stands in tip " + in_quotes(tips_[t].name),
                         "of or in of an instrument, or leave it out");
    for (const char* key : {"base", "placement"})
      if (const Value* unused = robot_.find(key); unused != nullptr && !from_base_)
        unused->fail("is of no use", "an instrument that measures from the base: one without in");
    place_tools();
    if (ways_.size() == 1) take_one_way();
    else take_ways();
  }

 private:
  std::string list_of_tips() const {
    std::string list;
    for (const std::string& name : names_) list += (list.empty() ? "tips: " : ", ") + name;
    return list;
  }

  const TipSpec& tip_named(const Located<std::string>& name, const std::string& key) {
    const auto found = std::ranges::find(tips_, name.value, &TipSpec::name);
    if (found == tips_.end())
      throw InputError(problem_.at(name.line),
                       key + ": the robot has no tip " + in_quotes(name.value) + meant_instead(name.value, names_),
                       list_of_tips());
    used_[std::size_t(found - tips_.begin())] = 1;
    return *found;
  }

  void add_way(MeasurementSpec& instrument) {
    if (!instrument.of && tips_.size() > 1)
      throw InputError(problem_.at(instrument.line), "measurement: an instrument does not say which tip it sees",
                       "of: one of these " + list_of_tips());
    if (!instrument.of) instrument.of = Located<std::string>{tips_.front().name, instrument.line};
    WaySpec way;
    way.of = tip_named(*instrument.of, "of");
    if (instrument.in && instrument.in->value == instrument.of->value)
      throw InputError(problem_.at(instrument.in->line),
                       "in: " + in_quotes(instrument.in->value) + " is the tip that the instrument sees",
                       "another tip, or none for the robot's base");
    if (instrument.in) way.in = tip_named(*instrument.in, "in");
    else from_base_ = true;
    if (std::ranges::none_of(ways_, [&](const WaySpec& known) { return measures(instrument, known); }))
      ways_.push_back(std::move(way));
  }

  void place_tools() const {
    if (!problem_.workspace.collision) return;
    for (const BodySpec& body : problem_.workspace.collision->tool) {
      const SourcePlace place = problem_.at(body.tip ? body.tip->line : body.line);
      if (!body.tip && ways_.size() > 1)
        throw InputError(place, "tool " + in_quotes(body.name) + " does not say which tip carries it",
                         "tip: one of these " + list_of_tips());
      if (body.tip && std::ranges::find(names_, body.tip->value) == names_.end())
        throw InputError(place,
                         "the robot has no tip " + in_quotes(body.tip->value) + meant_instead(body.tip->value, names_),
                         list_of_tips());
      if (body.tip && ways_.size() == 1 && body.tip->value != ways_.front().of.name)
        throw InputError(place, "a tool on the tip that the only instrument stands in is not checked for collision",
                         "tip: " + ways_.front().of.name + ", or a <collision> shape in the URDF");
    }
  }

  /// That is the arm from a base to a tip, as any other.
  void take_one_way() {
    const WaySpec& way = ways_.front();
    if (way.in) arm_.base = way.in->link;
    arm_.tip = way.of.link;
    for_each_instrument(problem_.measurement, [](MeasurementSpec& instrument) {
      instrument.of.reset();
      instrument.in.reset();
    });
  }

  void take_ways() {
    if (const Value* elastostatic = robot_.find("elastostatic"))
      elastostatic->fail("bends an arm with several tips", "one tip, or no elastostatic");
    if (const Value* workspace = root_.find("workspace"))
      if (const Section section(*workspace); section.has("tool"))
        section.at("tool").fail("is a box for one tip alone", "leave it out, or tips that all instruments see");
    if (problem_.workspace.collision)
      for (const BodySpec& body : problem_.workspace.collision->obstacles)
        if (!body.station.empty())
          throw InputError(problem_.at(body.line), "an instrument's own body is of a robot with one tip alone",
                           "no station: it then stands in the root of the URDF");
    arm_.ways = std::move(ways_);
  }

  const Section& root_;
  const Section& robot_;
  Problem& problem_;
  SerialArmSpec& arm_;
  std::vector<TipSpec> tips_;
  std::vector<std::string> names_;
  std::vector<char> used_;
  std::vector<WaySpec> ways_;
  bool from_base_ = false;
};

}  // namespace

bool measures(const MeasurementSpec& instrument, const WaySpec& way) {
  return way.of.name == instrument.of->value && way.in.has_value() == instrument.in.has_value() &&
         (!way.in || way.in->name == instrument.in->value);
}

void read_ways(const Section& root, Problem& problem) {
  const Section robot(root.at("robot"));
  if (const Value* tips = robot.find("tips")) {
    WaysReader(root, robot, *tips, problem).read();
    return;
  }
  const std::string needed = "robot: {tips: {NAME: LINK, …}}";
  for_each_instrument(problem.measurement, [&](MeasurementSpec& instrument) {
    if (const auto& tip = instrument.of ? instrument.of : instrument.in)
      throw InputError(problem.at(tip->line), in_quotes(tip->value) + " is a tip, and the robot has no tips", needed);
  });
  if (!problem.workspace.collision) return;
  for (const BodySpec& body : problem.workspace.collision->tool)
    if (body.tip)
      throw InputError(problem.at(body.tip->line), in_quotes(body.tip->value) + " is a tip, and the robot has no tips",
                       needed);
}

}  // namespace posewright
