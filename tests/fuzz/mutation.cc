// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

namespace flatlight {
namespace {

constexpr std::array kExtremes = {
    "0",          "-0",         "-1",      "1e-320",  "5e-324",       "1e308",
    "-1e308",     "1e999",      "-1e999",  "1e-999",  "NaN",          "-inf",
    "4294967295", "4294967296", "0.1e1",   "1E+2",    "256.0",        "1.5",
    "1e100",      "1e101",      "-1e100",  "1e-100",  "1e15",         "9007199254740993",
    "0.9999999",  "1",          "6.28318", "6.28319", "-6.283185307", "18446744073709551616"};

constexpr std::array kTokens = {"null",        "true",
                                "{}",          "[]",
                                "\"\"",        "{\"x\":1,\"x\":2}",
                                "[[[[]]]]",    "\"points\"",
                                "\"arc\"",     "\"a\"",
                                "\"side\"",    "\"start_angle\"",
                                "\"BACK\"",    "\"\\u0000\"",
                                "\"\\ud834\"", "\"\xc3\xa4\xe2\x82\xac\"",
                                "\"\xff\"",    ":",
                                ",",           "}",
                                "]",           "//",
                                "'",           "\xef\xbb\xbf"};

std::size_t Below(std::size_t bound, std::mt19937_64& random) { return random() % bound; }

bool IsWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '+'; }

// Strings, words and numbers, single characters; joined again they are the text.
std::vector<std::string> Tokens(const std::string& text) {
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    if (text[i] == '"') {
      while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
      end = std::min(end + 1, text.size());
    } else if (IsWord(text[i])) {
      while (end < text.size() && IsWord(text[end])) ++end;
    }
    tokens.push_back(text.substr(i, end - i));
    i = end;
  }
  return tokens;
}

using Json = nlohmann::ordered_json;

// Every value below `json`. The texts are small and flat.
void CollectValues(Json& json, std::vector<Json*>& values) {
  for (Json& child : json) {
    values.push_back(&child);
    if (child.is_structured()) CollectValues(child, values);
  }
}

constexpr std::array kNumbers = {0.0,    -0.0,  1.0,    -1.0,      0.5,         1e-320,      5e-324,
                                 1e-100, 1e100, 1e101,  -1e100,    1e308,       1e15,        256.0,
                                 1.5,    3.0,   0.3,    0.9999999, 4294967295., 4294967296., 6.28318,
                                 6.3,    -6.28, 3.1416, 1e-15,     2.0,         1e6,         0x1.0p-1000};

constexpr std::array kNames = {"floor",   "lamp",     "white",  "black", "light",    "arc",
                               "segment", "polyline", "points", "x",     "count",    "BACK",
                               "",        "\u0000",   "curve",  "a",     "emission", "twoSided"};

void ChangeOne(Json& root, std::mt19937_64& random) {
  std::vector<Json*> values;
  CollectValues(root, values);
  if (values.empty()) return;
  Json& value = *values[Below(values.size(), random)];
  const std::size_t kind = Below(8, random);
  if (kind < 3) {
    std::vector<Json*> numbers;
    std::copy_if(values.begin(), values.end(), std::back_inserter(numbers),
                 [](const Json* v) { return v->is_number(); });
    if (!numbers.empty()) *numbers[Below(numbers.size(), random)] = kNumbers[Below(kNumbers.size(), random)];
  } else if (kind == 3) {
    const Json other = *values[Below(values.size(), random)];
    value = other;
  } else if (kind == 4) {
    value = kNames[Below(kNames.size(), random)];
  } else if (value.is_array() && !value.empty()) {
    const std::size_t index = Below(value.size(), random);
    if (kind == 5) {
      value.erase(index);
    } else {
      const Json copy = value[index];
      value.push_back(copy);
    }
  } else if (value.is_object() && !value.empty()) {
    auto member = value.begin();
    std::advance(member, static_cast<std::ptrdiff_t>(Below(value.size(), random)));
    const Json copy = *member;
    const bool renames = kind == 6;
    value.erase(member);
    if (renames) value[kNames[Below(kNames.size(), random)]] = copy;
  }
}

}  // namespace

std::string WithChangedText(const std::string& text, std::mt19937_64& random) {
  if (text.empty()) return kTokens[Below(kTokens.size(), random)];
  std::string result = text;
  const std::size_t kind = Below(16, random);
  if (kind == 0) {
    const auto bit = static_cast<unsigned char>(1U << Below(8, random));
    char& byte = result[Below(result.size(), random)];
    byte = static_cast<char>(static_cast<unsigned char>(byte) ^ bit);
    return result;
  }
  if (kind == 1) return text.substr(0, Below(text.size(), random));
  std::vector<std::string> tokens = Tokens(text);
  const std::size_t at = Below(tokens.size(), random);
  const auto begin = tokens.begin() + static_cast<std::ptrdiff_t>(at);
  const std::size_t most = std::min<std::size_t>(tokens.size() - at, 40);
  const auto length = static_cast<std::ptrdiff_t>(1 + Below(most, random));
  if (kind < 8) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      if (IsWord(tokens[i][0])) numbers.push_back(i);
    }
    if (!numbers.empty()) tokens[numbers[Below(numbers.size(), random)]] = kExtremes[Below(kExtremes.size(), random)];
  } else if (kind < 10) {
    *begin = kTokens[Below(kTokens.size(), random)];
  } else if (kind < 12) {
    std::swap(*begin, tokens[Below(tokens.size(), random)]);
  } else if (kind < 14) {
    tokens.erase(begin, begin + length);
  } else {
    const std::vector<std::string> copy(begin, begin + length);
    tokens.insert(tokens.begin() + static_cast<std::ptrdiff_t>(Below(tokens.size(), random)), copy.begin(), copy.end());
  }
  result.clear();
  for (const std::string& token : tokens) result += token;
  return result;
}

std::string WithChangedMeaning(const std::string& text, std::mt19937_64& random) {
  Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) return text;
  ChangeOne(json, random);
  return json.dump();
}

}  // namespace flatlight
