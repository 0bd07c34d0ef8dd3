// VAL 3: points are in the .dtx file, <Value key="0" j1="0" … j6="0"/>; the programs beside it (.pgx) move to them.

#include <algorithm>
#include <cstdlib>

#include "reading.hpp"

namespace posewright::programs {
namespace {

using Kind = Expression::Kind;
using Form = FoundPoint::Form;

const Grammar& val3_grammar() {
  static const Grammar rules = {{'{', '[', false, false},
                                false,
                                0,
                                nullptr,
                                {{"movej"}, {"movel"}, {"movec", Role::pose, 0, 2}},
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
      }
    }
  }

  void mark_remark(std::size_t at) {
    if (!found_.reading.remark) found_.reading.remark = RemarkPlace{at, "<!-- ", " -->"};
  }

  void add_value(const std::string& name, bool pose, const std::vector<Attribute>& attributes, int line) {
    FoundPoint point{line, name, pose ? Form::pose : Form::joints};
    static const std::vector<std::string> of_pose = {"x", "y", "z", "rx", "ry", "rz"};
    for (const Attribute& a : attributes) {
      if (a.name == "key") point.index = std::atol(source_.text.substr(a.begin, a.end - a.begin).c_str());
      const bool wanted = pose ? std::find(of_pose.begin(), of_pose.end(), a.name) != of_pose.end()
                               : a.name.size() == 2 && a.name[0] == 'j' && is_digit(a.name[1]);
      if (!wanted) continue;
      const std::vector<Token> tokens = tokens_of(source_.text, {}, a.begin, a.end);
      TokenCursor cursor(source_.text, tokens);
      const Expression value = read_expression(cursor, val3_grammar().expressions);
      if (value.is(Kind::constant) && cursor.done()) {
        point.axes.emplace_back(a.name, TextNumber{value.begin, value.end, value.value});
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
    if (const Motion* motion = found_.motion(word))
      found_.move(*motion, word, called.is(Kind::call) ? called.items : std::vector<Expression>(), line);
    else if (called.is(Kind::call)) found_.pass(word, called.items, line, own ? Role::passed : Role::operand);
  }

  /// p.trsf.z=…, j[n]=herej(): what follows is seen on its own.
  void assignment(TokenCursor& cursor) {
    const std::string name(cursor.text());
    const int line = cursor.now().line;
    TokenCursor ahead = cursor;
    read_name(ahead);
    if (ahead.sees('=') && !ahead.ahead(1).is('=', ahead.source())) {
      found_.change(name, line, "=");
      cursor = ahead;
    }
    cursor.skip();
  }

  static void read_name(TokenCursor& cursor) {
    cursor.skip();
    while (cursor.sees('[') || cursor.sees('.')) {
      if (cursor.take('.')) {
        cursor.skip();
      } else {
        cursor.skip_to("]", true);
        cursor.take(']');
      }
    }
  }

  const Source& source_;
  Collector found_;
};

}  // namespace

Reading read_val3(const Source& source) { return Val3(source).run(); }

}  // namespace posewright::programs
