// SPDX-License-Identifier: Apache-2.0
#include "client/cli/formats/csv_syntax.h"

#include "client/cli/status/exit_code.h"

namespace flatlight {
namespace {

class Parser {
 public:
  Parser(const std::string& bytes, const std::string& label) : bytes_(bytes), label_(label) {}

  absl::StatusOr<std::vector<std::vector<CsvField>>> Run() {
    std::vector<std::vector<CsvField>> rows;
    while (!AtEnd()) {
      rows.emplace_back();
      do {
        rows.back().push_back({"", line_, column_});
        if (absl::Status read = ReadField(rows.back().back().text); !read.ok()) return read;
      } while (Skip(','));
      if (AtEnd()) return Error("the file ends in the middle of a row");
      if (bytes_[at_] == '\r') Advance();
      if (AtEnd() || bytes_[at_] != '\n') return Error("a line break should end the row here");
      Advance();
    }
    return rows;
  }

 private:
  bool AtEnd() const { return at_ >= bytes_.size(); }

  void Advance() {
    const bool line_break = bytes_[at_++] == '\n';
    line_ += line_break ? 1 : 0;
    column_ = line_break ? 1 : column_ + 1;
  }

  bool Skip(char c) {
    if (AtEnd() || bytes_[at_] != c) return false;
    Advance();
    return true;
  }

  absl::Status ReadField(std::string& text) {
    if (Skip('"')) return ReadQuoted(text);
    for (; !AtEnd() && bytes_[at_] != ',' && bytes_[at_] != '\n' && bytes_[at_] != '\r'; Advance()) {
      if (bytes_[at_] == '"') return Error("a quotation mark inside a value without quotes");
      if (static_cast<unsigned char>(bytes_[at_]) < 32) return Error("a control character");
      text += bytes_[at_];
    }
    return absl::OkStatus();
  }

  absl::Status ReadQuoted(std::string& text) {
    const CsvField start{"", line_, column_ - 1};
    for (;;) {
      if (AtEnd()) return UsageError(label_ + ": " + PlaceOf(start) + ": the quotation mark is never closed");
      const char c = bytes_[at_];
      Advance();
      if (c == '"' && !Skip('"')) break;
      text += c;
    }
    if (!AtEnd() && bytes_[at_] != ',' && bytes_[at_] != '\n' && bytes_[at_] != '\r')
      return Error("a comma or a line break should follow the closing quotation mark");
    return absl::OkStatus();
  }

  absl::Status Error(const std::string& what) const {
    return UsageError(label_ + ": " + PlaceOf({"", line_, column_}) + ": " + what);
  }

  const std::string& bytes_;
  const std::string& label_;
  std::size_t at_ = 0;
  int line_ = 1;
  int column_ = 1;
};

}  // namespace

std::string PlaceOf(const CsvField& field) {
  return "line " + std::to_string(field.line) + ", column " + std::to_string(field.column);
}

absl::StatusOr<std::vector<std::vector<CsvField>>> ParseCsv(const std::string& bytes, const std::string& label) {
  return Parser(bytes, label).Run();
}

std::string CsvText(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

}  // namespace flatlight
