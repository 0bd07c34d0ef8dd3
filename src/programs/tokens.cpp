#include "tokens.hpp"

#include <algorithm>

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

}  // namespace posewright::programs
