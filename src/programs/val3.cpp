// VAL 3: points are in the .dtx file, <Value key="0" j1="0" … j6="0"/>, or as poses in the frame of fatherId with the
// configuration shoulder, elbow, wrist; frames and tools are there, too. The programs beside it (.pgx) move to them.

#include <algorithm>

#include "pose_form.hpp"
#include "reading.hpp"

namespace posewright::programs {
namespace {

using Kind = Expression::Kind;
using Form = FoundPoint::Form;

const Grammar& val3_grammar() {
  static const Grammar rules = {{'{', '[', false, false},
                                false,
                                0,
                                [](const std::string& word) { return word == "MOVEL"; },
                                {{{"movej", "movel"}}, {{"movec"}, Role::pose, 0, 2}},
                                {"appro", "compose"},
                                {"herej", "here"},
                                [](const Expression&, const Source&) { return std::optional<FoundPoint>(); }};
  return rules;
}

/// Attributes of a tag: name and place of the value between quotes.
struct Attribute {
  std::string name;
  std::size_t begin, end;
};

std::vector<Attribute> attributes_of(std::string_view text, std::size_t begin, std::size_t end) {
  std::vector<Attribute> result;
  for (std::size_t at = begin; at < end; ++at) {
    if (text[at] != '=') continue;
    std::size_t name_end = at, open = at + 1;
    while (name_end > begin && text[name_end - 1] == ' ') --name_end;
    std::size_t name = name_end;
    while (name > begin && (is_word(text[name - 1]) || text[name - 1] == ':')) --name;
    while (open < end && text[open] == ' ') ++open;
    if (open >= end || (text[open] != '"' && text[open] != '\'')) continue;
    const std::size_t close = std::min(text.find(text[open], open + 1), end);
    result.push_back({std::string(text.substr(name, name_end - name)), open + 1, close});
    at = close;
  }
  return result;
}

class Val3 {
 public:
  explicit Val3(const Source& source) : source_(source), found_(val3_grammar(), source) {}

  Reading run() {
    data();
    for (const auto& [name, frame] : frames_)
      if (const auto values = whole(name, 0)) found_.reading.frames[name] = *values;
    code();
    return std::move(found_.reading);
  }

 private:
  void data() {
    const std::string_view text = source_.text;
    int line = 1;
    std::size_t counted = 0;
    std::string name, type;
    for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at + 1)) {
      line += int(std::count(text.begin() + long(counted), text.begin() + long(at), '\n'));
      counted = at;
      if (text.substr(at).starts_with("<!--")) {
        at = std::min(text.find("-->", at), text.size());
        continue;
      }
      const std::size_t end = std::min(text.find('>', at), text.size());
      const std::string_view tag = text.substr(at, end - at);
      if (tag.starts_with("<Database") || tag.starts_with("<Programs")) mark_remark(at);
      if (!tag.starts_with("<Data ") && !tag.starts_with("<Value ")) continue;
      const std::vector<Attribute> attributes = attributes_of(text, at, end);
      const auto value = [&](const char* wanted) {
        for (const Attribute& a : attributes)
          if (a.name == wanted) return std::string(text.substr(a.begin, a.end - a.begin));
        return std::string();
      };
      if (tag.starts_with("<Data ")) {
        name = value("name");
        type = value("type");
      } else if (type.starts_with("joint") || type.starts_with("point")) {
        add_value(name, type.starts_with("point"), attributes, line);
      } else if (type == "frame" || type == "tool") {
        add_frame(name, attributes);
      }
    }
  }

  void mark_remark(std::size_t at) {
    if (!found_.reading.remark) found_.reading.remark = RemarkPlace{at, "<!-- ", " -->"};
  }

  struct Frame {
    std::vector<double> values;  ///< in the father
    std::string father;
  };

  /// Name of an element of an array: without an index for the first, which is meant where none is stated.
  static std::string element(const std::string& name, long index) {
    return index == 0 ? name : name + "[" + std::to_string(index) + "]";
  }
  /// That of "fTable[0]".
  static std::string element(std::string_view reference) {
    const std::size_t open = std::min(reference.find('['), reference.size());
    return element(std::string(reference.substr(0, open)),
                   open < reference.size() ? std::atol(std::string(reference.substr(open + 1, 9)).c_str()) : 0);
  }

  std::string_view text_of(const Attribute& a) const {
    return std::string_view(source_.text).substr(a.begin, a.end - a.begin);
  }

  /// The number of an attribute; none: it is something else.
  std::optional<TextNumber> number(const Attribute& a) const {
    const std::vector<Token> tokens = tokens_of(source_.text, {}, a.begin, a.end);
    TokenCursor cursor(source_.text, tokens);
    const Expression value = read_expression(cursor, val3_grammar().expressions);
    if (!value.is(Kind::constant) || !cursor.done()) return std::nullopt;
    return TextNumber{value.begin, value.end, value.value};
  }

  /// A coordinate that is not stated is zero.
  void add_frame(const std::string& name, const std::vector<Attribute>& attributes) {
    const std::vector<std::string>& names = val3_pose().values;
    Frame frame{std::vector<double>(names.size(), 0.0), ""};
    long key = 0;
    for (const Attribute& a : attributes) {
      if (a.name == "key") key = std::atol(std::string(text_of(a)).c_str());
      if (a.name == "fatherId") frame.father = element(text_of(a));
      const auto at = std::ranges::find(names, a.name);
      if (at == names.end()) continue;
      const auto value = number(a);
      if (!value) return;
      frame.values[std::size_t(at - names.begin())] = value->value;
    }
    frames_[element(name, key)] = frame;
  }

  /// Values of a frame in the world, of a tool in the flange.
  std::optional<std::vector<double>> whole(const std::string& name, int depth) const {
    if (name.empty() || name == "world" || name == "flange") return std::vector<double>(6, 0.0);
    const auto at = frames_.find(name);
    if (at == frames_.end() || depth > 20) return std::nullopt;
    const auto father = whole(at->second.father, depth + 1);
    if (!father) return std::nullopt;
    return val3_pose().written(val3_pose().place(*father) * val3_pose().place(at->second.values));
  }

  FrameName named_frame(const std::string& name) const {
    if (name.empty() || name == "world" || name == "flange") return {"world", std::vector<double>(6, 0.0)};
    return {name};
  }

  /// lefty or righty and so on; what depends on where the robot is makes the point unclear.
  void add_status(FoundPoint& point, std::size_t which, const Attribute& a) const {
    for (std::size_t k = 0; k < 2; ++k)
      if (text_of(a) == val3_status_words()[which][k]) {
        point.axes.emplace_back(a.name, TextNumber{a.begin, a.end, double(k)});
        return;
      }
    point.form = Form::unclear;
    point.why = "the controller chooses its " + a.name + " (" + std::string(text_of(a)) + ")";
  }

  void add_value(const std::string& name, bool pose, const std::vector<Attribute>& attributes, int line) {
    FoundPoint point{line, name, pose ? Form::pose : Form::joints};
    const std::vector<std::string>&of_pose = val3_pose().values, &status = val3_pose().status;
    if (pose) point.frames.base = named_frame("");
    for (const Attribute& a : attributes) {
      if (a.name == "key") point.index = std::atol(std::string(text_of(a)).c_str());
      if (pose && a.name == "fatherId") point.frames.base = named_frame(element(text_of(a)));
      if (const auto at = std::ranges::find(status, a.name); pose && at != status.end())
        add_status(point, std::size_t(at - status.begin()), a);
      const bool wanted = pose ? std::ranges::find(of_pose, a.name) != of_pose.end()
                               : a.name.size() == 2 && a.name[0] == 'j' && is_digit(a.name[1]);
      if (!wanted) continue;
      if (const auto value = number(a)) {
        point.axes.emplace_back(a.name, *value);
      } else {
        point.form = Form::unclear;
        point.why = "has a value that is no number";
      }
    }
    found_.reading.points.push_back(point);
  }

  /// From the word `begin` on, which data files do not have.
  void code() {
    const std::string_view text = source_.text;
    const std::size_t opened = std::min(text.find("<Code>"), text.find("<code>"));
    if (opened >= text.size()) return;
    const int line = 1 + int(std::count(text.begin(), text.begin() + long(opened), '\n'));
    const std::vector<Token> tokens = tokens_of(text, {"//", "\"", "_", true}, opened, text.size(), line);
    TokenCursor cursor(text, tokens);
    while (!cursor.done()) {
      if (!cursor.is_word()) {
        cursor.skip();
      } else if (cursor.ahead(1).is('(', text)) {
        call(cursor);
      } else {
        assignment(cursor);
      }
    }
  }

  void call(TokenCursor& cursor) {
    const std::string word(cursor.text());
    TokenCursor ahead = cursor;
    const bool own = cursor.at > 0 && cursor.text(cursor.before()) == "call";
    const Expression called = read_expression(ahead, val3_grammar().expressions);
    const int line = cursor.now().line;
    cursor.skip();
    const std::vector<Expression> arguments = called.is(Kind::call) ? called.items : std::vector<Expression>();
    if (const Motion* motion = found_.motion(word)) {
      found_.frames.tool = tool_of(arguments, motion->count);
      found_.move(*motion, word, arguments, line);
    } else if (word == "setFrame" && arguments.size() == 4) {
      found_.change(arguments[3].word, line, word);
    } else if (called.is(Kind::call)) {
      found_.pass(word, called.items, line, own ? Role::passed : Role::operand);
    }
  }

  /// movel(point, tool, speed)
  FrameName tool_of(const std::vector<Expression>& arguments, std::size_t place) const {
    if (place >= arguments.size() || !arguments[place].is(Kind::name) || arguments[place].component)
      return {"an expression"};
    const Expression& tool = arguments[place];
    if (tool.items.empty()) return named_frame(tool.word);
    if (tool.items.size() > 1 || !tool.items[0].is(Kind::constant)) return {"an expression"};
    return named_frame(element(tool.word, std::lround(std::clamp(tool.items[0].value, 0.0, 1e6))));
  }

  /// p.trsf.z=…, j[n]=herej(): what follows is seen on its own.
  void assignment(TokenCursor& cursor) {
    TokenCursor ahead = cursor;
    const TakenName left = take_name(ahead, '[', "]", true);
    if (ahead.sees('=') && !ahead.ahead(1).is('=', ahead.source())) {
      found_.change(left.name, left.line, "=");
      cursor = ahead;
    }
    cursor.skip();
  }

  const Source& source_;
  Collector found_;
  std::map<std::string, Frame> frames_;
};

}  // namespace

Reading read_val3(const Source& source) { return Val3(source).run(); }

}  // namespace posewright::programs
