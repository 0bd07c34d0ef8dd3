#include "expression.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "posewright/support/read_number.hpp"

namespace posewright::programs {
namespace {

class Lexer {
 public:
  Lexer(std::string_view text, const LexRules& rules, std::size_t begin, std::size_t end, int line)
      : text_(text.substr(0, std::min(end, text.size()))), rules_(rules), at_(begin), line_(line) {}

  std::vector<Token> run() {
    while (at_ < text_.size()) step();
    add(Token::Kind::end, at_);
    return std::move(tokens_);
  }

 private:
  void step() {
    const char c = text_[at_];
    if (c == '\n') return new_line();
    if (c == ' ' || c == '\t' || c == '\r') {
      ++at_;
      return;
    }
    if (!rules_.comment.empty() && text_.substr(at_).starts_with(rules_.comment)) {
      at_ = line_end();
      return;
    }
    if (rules_.quotes.find(c) != std::string_view::npos) return quoted(c);
    if (is_digit(c) || (c == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) return number();
    if (is_letter(c) || rules_.letters.find(c) != std::string_view::npos) return word();
    add(Token::Kind::symbol, at_ + 1);
  }

  std::size_t line_end() const { return std::min(text_.find('\n', at_), text_.size()); }

  void add(Token::Kind kind, std::size_t end, double value = 0) {
    tokens_.push_back({kind, at_, end, line_, value});
    at_ = end;
  }

  void new_line() {
    if (rules_.lines) add(Token::Kind::line_end, at_ + 1);
    else ++at_;
    ++line_;
  }

  void quoted(char mark) {
    const std::size_t close = text_.find(mark, at_ + 1), end = line_end();
    add(Token::Kind::text, close < end ? close + 1 : end);
  }

  void number() {
    double value = 0;
    const char* first = text_.data() + at_;
    const auto [stop, code] = read_number(first, text_.data() + text_.size(), value);
    if (code != std::errc() || stop == first) return add(Token::Kind::symbol, at_ + 1);
    add(Token::Kind::number, at_ + std::size_t(stop - first), value);
  }

  void word() {
    std::size_t end = at_ + 1;
    while (end < text_.size() && (is_word(text_[end]) || rules_.letters.find(text_[end]) != std::string_view::npos))
      ++end;
    add(Token::Kind::word, end);
  }

  std::string_view text_;
  const LexRules& rules_;
  std::size_t at_;
  int line_;
  std::vector<Token> tokens_;
};

using Kind = Expression::Kind;

// Deeper brackets than these nobody writes.
constexpr int deepest = 40;

char closing(char open) { return open == '[' ? ']' : open == '{' ? '}' : ')'; }

class Reader {
 public:
  Reader(TokenCursor& cursor, const ExpressionRules& rules) : cursor_(cursor), rules_(rules) {}

  Expression sum(int depth) {
    Expression left = product(depth);
    while (!cursor_.done()) {
      // Of the languages here KRL alone joins frames by a colon; others end labels and cases with it.
      const char sign = operator_here(rules_.labels ? "+-:=<>" : "+-=<>");
      if (sign == '\0') break;
      left = joined(sign, std::move(left), depth, [&] { return product(depth + 1); });
    }
    return left;
  }

 private:
  char operator_here(std::string_view signs) {
    skip_line_ends();
    if (cursor_.now().kind != Token::Kind::symbol) return '\0';
    const char c = cursor_.source()[cursor_.now().begin];
    return signs.find(c) == std::string_view::npos ? '\0' : c;
  }

  Expression product(int depth) {
    Expression left = signed_primary(depth);
    while (!cursor_.done()) {
      const char sign = operator_here("*/");
      if (sign == '\0') break;
      left = joined(sign, std::move(left), depth, [&] { return signed_primary(depth + 1); });
    }
    return left;
  }

  template <class Right>
  Expression joined(char sign, Expression left, int depth, const Right& right) {
    cursor_.skip();
    Expression result;
    result.begin = left.begin;
    result.line = left.line;
    if (depth > deepest) return result;
    Expression other = right();
    result.end = other.end;
    if (left.is(Kind::constant) && other.is(Kind::constant)) {
      if (const auto value = computed(sign, left.value, other.value)) {
        result.kind = Kind::constant;
        result.value = *value;
        return result;
      }
    }
    result.items.push_back(std::move(left));
    result.items.push_back(std::move(other));
    return result;
  }

  static std::optional<double> computed(char sign, double a, double b) {
    double value = NAN;
    if (sign == '+') value = a + b;
    if (sign == '-') value = a - b;
    if (sign == '*') value = a * b;
    if (sign == '/') value = a / b;
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  }

  Expression signed_primary(int depth) {
    skip_line_ends();
    const Token first = cursor_.now();
    const bool minus = cursor_.sees('-');
    if (!minus && !cursor_.sees('+')) return primary(depth);
    cursor_.skip();
    Expression value = depth > deepest ? Expression{} : signed_primary(depth + 1);
    if (value.is(Kind::constant)) {
      if (minus) value.value = -value.value;
    } else {
      Expression whole;
      whole.end = value.end;
      whole.items.push_back(std::move(value));
      value = std::move(whole);
    }
    value.begin = first.begin;
    value.line = first.line;
    return value;
  }

  Expression primary(int depth) {
    Expression result;
    const Token& token = cursor_.now();
    result.begin = token.begin;
    result.end = token.end;
    result.line = token.line;
    if (depth > deepest) {
      cursor_.skip();
      return result;
    }
    if (token.kind == Token::Kind::number) return number(result);
    if (token.kind == Token::Kind::word) return named(result, depth);
    if (cursor_.sees(rules_.list)) return list(result, depth);
    if (cursor_.sees('(')) return in_parentheses(result, depth);
    if (token.kind == Token::Kind::text) cursor_.skip();
    return result;
  }

  Expression number(Expression result) {
    result.kind = std::isfinite(cursor_.now().value) ? Kind::constant : Kind::other;
    result.value = cursor_.now().value;
    cursor_.skip();
    return result;
  }

  Expression in_parentheses(Expression result, int depth) {
    const std::size_t begin = result.begin;
    cursor_.skip();
    ++open_;
    result = sum(depth + 1);
    skip_line_ends();
    --open_;
    result.begin = begin;
    if (cursor_.sees(')')) {
      result.end = cursor_.now().end;
      cursor_.skip();
    } else {
      result.kind = Kind::other;
    }
    return result;
  }

  /// Items between brackets; what is neither an item nor a comma makes the list `other`.
  Expression list(Expression result, int depth) {
    const char close = closing(cursor_.source()[cursor_.now().begin]);
    cursor_.skip();
    ++open_;
    result.kind = Kind::list;
    while (!cursor_.done()) {
      skip_line_ends();
      if (cursor_.sees(close)) break;
      const std::size_t start = cursor_.at;
      result.items.push_back(item(depth + 1));
      skip_line_ends();
      if (cursor_.take(',')) continue;
      if (cursor_.sees(close)) break;
      if (cursor_.sees(':') && result.items.size() == 1) {  // {E6AXIS: A1 …}
        cursor_.skip();
        result.items.clear();
        continue;
      }
      result.kind = Kind::other;
      if (cursor_.at == start || cursor_.sees(';') || cursor_.sees(')')) break;
    }
    skip_line_ends();
    --open_;
    result.end = cursor_.now().end;
    if (!cursor_.take(close)) result.kind = Kind::other;
    return result;
  }

  Expression item(int depth) {
    std::string label;
    if (rules_.labels && cursor_.is_word()) {
      const Token& next = cursor_.ahead(1);
      const bool typed = next.is(':', cursor_.source());
      if (typed || next.kind == Token::Kind::number || next.kind == Token::Kind::word ||
          next.kind == Token::Kind::text || next.is('-', cursor_.source()) || next.is('+', cursor_.source()) ||
          next.is(rules_.list, cursor_.source()) || next.is(rules_.index, cursor_.source())) {
        label = upper(cursor_.text());
        if (!typed) cursor_.skip();
        else return label_alone(label);
        if (cursor_.take(rules_.index)) cursor_.take(closing(rules_.index));
      }
    }
    Expression value = sum(depth);
    value.label = std::move(label);
    return value;
  }

  Expression label_alone(const std::string& label) {
    Expression type;
    type.word = label;
    type.line = cursor_.now().line;
    cursor_.skip();
    return type;
  }

  Expression named(Expression result, int depth) {
    result.word = cursor_.text();
    result.kind = Kind::name;
    cursor_.skip();
    if (cursor_.sees('(')) return call(std::move(result), depth);
    if (cursor_.sees(rules_.list) && rules_.list == '[' && result.word == "p" && cursor_.now().begin == result.end) {
      Expression pose = list(std::move(result), depth);
      pose.word = "p";
      return pose;
    }
    if (result.word == "pi" || result.word == "PI") {
      result.kind = Kind::constant;
      result.value = std::numbers::pi;
      return result;
    }
    return with_parts(std::move(result), depth);
  }

  /// Indices and components behind a name.
  Expression with_parts(Expression result, int depth) {
    while (!cursor_.done()) {
      if (cursor_.sees(rules_.index)) {
        const Expression index = list({}, depth + 1);
        result.items.insert(result.items.end(), index.items.begin(), index.items.end());
        result.end = index.end;
      } else if (cursor_.sees('.') && cursor_.ahead(1).kind == Token::Kind::word) {
        result.component = true;
        cursor_.skip();
        result.end = cursor_.now().end;
        cursor_.skip();
      } else {
        break;
      }
    }
    return result;
  }

  Expression call(Expression result, int depth) {
    Expression arguments = list(result, depth);
    result.kind = Kind::call;
    result.end = arguments.end;
    result.items = std::move(arguments.items);
    if (arguments.is(Kind::other)) result.component = true;
    if ((result.word == "d2r" || result.word == "r2d") && result.items.size() == 1 &&
        result.items[0].is(Kind::constant)) {
      const double turn = std::numbers::pi / 180;
      result.value = result.word == "d2r" ? result.items[0].value * turn : result.items[0].value / turn;
      result.kind = Kind::constant;
      result.items.clear();
    }
    return with_parts(std::move(result), depth);
  }

  void skip_line_ends() {
    while (open_ > 0 && cursor_.now().kind == Token::Kind::line_end) cursor_.skip();
  }

  TokenCursor& cursor_;
  const ExpressionRules& rules_;
  int open_ = 0;
};

}  // namespace

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
  return result;
}

std::vector<Token> tokens_of(std::string_view text, const LexRules& rules, std::size_t begin, std::size_t end,
                             int first_line) {
  return Lexer(text, rules, begin, end, first_line).run();
}

const Token& TokenCursor::ahead(std::size_t count) const {
  return (*tokens_)[std::min(at + count, tokens_->size() - 1)];
}

void TokenCursor::skip_to(std::string_view symbols, bool line_ends) {
  while (!done()) {
    if (line_ends && now().kind == Token::Kind::line_end) return;
    if (now().kind == Token::Kind::symbol && symbols.find(source_[now().begin]) != std::string_view::npos) return;
    skip();
  }
}

Expression read_expression(TokenCursor& cursor, const ExpressionRules& rules) { return Reader(cursor, rules).sum(0); }

TakenName take_name(TokenCursor& cursor, char open, std::string_view close, bool in_line) {
  TakenName taken{std::string(cursor.text()), cursor.now().line};
  cursor.skip();
  while (cursor.sees(open) || cursor.sees('.')) {
    if (cursor.take('.')) {
      taken.component = true;
      cursor.skip();
    } else {
      if (cursor.ahead(1).kind == Token::Kind::number) taken.index = long(std::min(cursor.ahead(1).value, 1e6));
      cursor.skip_to(close, in_line);
      cursor.take(close.front());
    }
  }
  return taken;
}

}  // namespace posewright::programs
