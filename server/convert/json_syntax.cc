// SPDX-License-Identifier: Apache-2.0
#include "server/convert/json_syntax.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "server/convert/text.h"

namespace flatlight {
namespace {

constexpr const char* kTooLarge = ", more than the largest number 1.797e308";

std::string LineAndColumn(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0.
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; };
  const std::string_view in_line = before.substr(line_start);
  const auto column = 1 + std::count_if(in_line.begin(), in_line.end(), [&](char c) { return !continues(c); });
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

// The parser shows a control character as <U+000A>: one byte of the text.
std::size_t RawLength(const std::string& token) {
  constexpr std::size_t kEscape = 8;
  std::size_t length = 0;
  for (std::size_t i = 0; i < token.size(); ++length) i += token.compare(i, 5, "<U+00") == 0 ? kEscape : 1;
  return length;
}

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool IsWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '+' || c == '.';
}

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// JSON's grammar of numbers is narrower than strtod's.
bool IsJsonNumber(std::string_view token) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t begin = i;
    while (i < token.size() && IsDigit(token[i])) ++i;
    return i > begin;
  };
  const auto take = [&](std::string_view any_of) {
    const bool found = i < token.size() && any_of.find(token[i]) != std::string_view::npos;
    if (found) ++i;
    return found;
  };
  take("-");
  if (!take("0") && !digits()) return false;
  if (take(".") && !digits()) return false;
  if (take("eE")) {
    take("+-");
    if (!digits()) return false;
  }
  return i == token.size();
}

// The run of letters, digits and signs that begins at an offset.
std::string_view WordFrom(std::string_view text, std::size_t begin) {
  std::size_t end = begin;
  while (end < text.size() && IsWordCharacter(text[end])) ++end;
  return text.substr(begin, end - begin);
}

// The one around an offset.
std::string_view WordAt(std::string_view text, std::size_t offset) {
  while (offset > 0 && IsWordCharacter(text[offset - 1])) --offset;
  return WordFrom(text, offset);
}

bool IsNotFinite(std::string_view word) {
  if (!word.empty() && (word.front() == '-' || word.front() == '+')) word.remove_prefix(1);
  std::string lower(word.substr(0, 9));
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

char LastBefore(std::string_view text, std::size_t offset) {
  while (offset > 0 && IsSpace(text[offset - 1])) --offset;
  return offset > 0 ? text[offset - 1] : '\0';
}

// The parser's own reason, without its preamble and without what it quotes.
std::string Reason(const std::string& message) {
  const std::size_t dash = message.find(" - ");
  const std::string reason = dash == std::string::npos ? message : message.substr(dash + 3);
  return reason.substr(0, reason.find("; last read: "));
}

bool IsAbout(const JsonSyntaxError& error, const char* part) { return error.message.find(part) != std::string::npos; }

// Where the token starts that the parser could not use. What it calls the token holds only numbers and strings
// reliably.
std::size_t TokenStart(std::string_view text, const JsonSyntaxError& error) {
  if (error.end > text.size()) return text.size();  // The end was read as a character.
  const std::size_t last = error.end - std::min<std::size_t>(error.end, 1);
  if (IsAbout(error, "invalid string")) return last;
  if (IsAbout(error, "unexpected string literal")) return error.end - std::min(error.end, RawLength(error.token));
  const std::string_view word = WordAt(text, last);
  return word.empty() ? last : static_cast<std::size_t>(word.data() - text.data());
}

std::string Explain(std::string_view text, std::size_t at, const JsonSyntaxError& error) {
  const bool in_string = IsAbout(error, "invalid string");
  if (at >= text.size()) {
    if (std::all_of(text.begin(), text.end(), IsSpace)) return "the text is empty; a JSON object is wanted";
    return in_string ? "the text ends inside a string" : "the text ends before its JSON object does";
  }
  if (error.overflow) return "is " + Shortened(error.token) + kTooLarge;
  const char c = text[at];
  const std::string_view word = WordAt(text, at);
  const bool for_key = IsAbout(error, "object key");
  const bool for_value = IsAbout(error, "parsing value") || IsAbout(error, "invalid number");
  if (IsAbout(error, "ill-formed UTF-8")) return "is not UTF-8";
  if (in_string) return Reason(error.message);
  if (IsAbout(error, "expected end of input")) {
    return "there is more text after the end of the JSON object";
  }
  if (c == '/' || c == '#') return "comments are not allowed in JSON";
  if (c == '\'') return "strings are written in double quotes, not in single ones";
  if ((c == '}' || c == ']') && LastBefore(text, at) == ',') {
    return std::string("a comma before ") + c + " is not allowed";
  }
  if (for_key && !word.empty()) return "the field name " + Shortened(word) + " must be in double quotes";
  if (for_value && !word.empty()) return Shortened(word) + " is not a JSON value";
  return "is not JSON: " + Reason(error.message);
}

}  // namespace

Diagnostic DescribeSyntaxError(std::string_view text, const JsonSyntaxError& error, const std::string& near) {
  const std::size_t at = TokenStart(text, error);
  return {LineAndColumn(text, at), Explain(text, at, error) + (near.empty() ? "" : " (near " + near + ')')};
}

Diagnostic DescribeNul(std::string_view text) {
  return {LineAndColumn(text, text.size()), "is not JSON: a NUL character"};
}

bool IsAboutUnusableNumber(std::string_view text, const JsonSyntaxError& error) {
  return error.overflow || IsNotFinite(WordAt(text, TokenStart(text, error)));
}

std::vector<UnusableNumber> BlankUnusableNumbers(std::string& text) {
  std::vector<UnusableNumber> unusable;
  std::size_t index = 0;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i) i += text[i] == '\\' ? 1 : 0;
      ++i;
      continue;
    }
    const std::string word(WordFrom(text, i));
    if (word.empty()) {
      ++i;
      continue;
    }
    const bool is_number = IsJsonNumber(word);
    const bool too_large = is_number && std::isinf(std::strtod(word.c_str(), nullptr));
    const bool not_finite = IsNotFinite(word);
    if (too_large || not_finite) {
      unusable.push_back({index, Shortened(word) + (too_large ? kTooLarge : ", which is not finite")});
      std::fill_n(text.begin() + static_cast<std::ptrdiff_t>(i), word.size(), ' ');
      text[i] = '0';
    }
    index += is_number || not_finite ? 1 : 0;
    i += word.size();
  }
  return unusable;
}

}  // namespace flatlight
