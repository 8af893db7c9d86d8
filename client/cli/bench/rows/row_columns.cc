// SPDX-License-Identifier: Apache-2.0
#include "client/cli/bench/rows/row_columns.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "client/cli/formats/csv_syntax.h"
#include "client/cli/text/numbers.h"

namespace flatlight {
namespace {

template <class Number>
bool Parse(const std::string& text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end && std::isfinite(static_cast<double>(number));
}

constexpr const char* kAmount = "a number from 0";
constexpr const char* kCount = "a whole number from 0 to 4294967295";

RowColumn TextColumn(const std::string& name, std::string BenchRow::*member) {
  return {name, [member](const BenchRow& row) { return row.*member; },
          [member](BenchRow& row, const std::string& text) {
            row.*member = text;
            return true;
          },
          "a text"};
}

RowColumn AmountColumn(const std::string& name, double BenchRow::*member) {
  return {name, [member](const BenchRow& row) { return FormatExactly(row.*member); },
          [member](BenchRow& row, const std::string& text) { return Parse(text, row.*member) && row.*member >= 0; },
          kAmount};
}

RowColumn CountColumn(const std::string& name, std::uint32_t BenchRow::*member) {
  return {name, [member](const BenchRow& row) { return std::to_string(row.*member); },
          [member](BenchRow& row, const std::string& text) { return Parse(text, row.*member); }, kCount};
}

RowColumn OptionalCountColumn(const std::string& name, std::optional<std::uint32_t> BenchRow::*member) {
  return {name, [member](const BenchRow& row) { return row.*member ? std::to_string(*(row.*member)) : ""; },
          [member](BenchRow& row, const std::string& text) {
            std::uint32_t value = 0;
            if (text.empty()) return true;
            const bool parsed = Parse(text, value);
            row.*member = value;
            return parsed;
          },
          std::string(kCount) + ", or nothing"};
}

// Columns of one quantity: its `rms` comes first and says whether the run has the quantity.
std::optional<QuantityError>& Of(BenchRow& row, BenchQuantity quantity) {
  return row.errors[static_cast<std::size_t>(quantity)];
}

RowColumn ErrorColumn(BenchQuantity quantity, const std::string& suffix, double QuantityError::*member) {
  return {
      NameOf(quantity) + suffix,
      [=](const BenchRow& row) { return row.ErrorOf(quantity) ? FormatExactly((*row.ErrorOf(quantity)).*member) : ""; },
      [=](BenchRow& row, const std::string& text) {
        if (text.empty()) return member != &QuantityError::rms && !Of(row, quantity);
        if (member == &QuantityError::rms) Of(row, quantity).emplace();
        return Of(row, quantity) && Parse(text, (*Of(row, quantity)).*member) && (*Of(row, quantity)).*member >= 0;
      },
      kAmount};
}

RowColumn RmsColumn(BenchQuantity quantity) {
  RowColumn column = ErrorColumn(quantity, "Rms", &QuantityError::rms);
  column.read = [quantity, read = column.read](BenchRow& row, const std::string& text) {
    return text.empty() || read(row, text);
  };
  column.allowed = std::string(kAmount) + ", or nothing";
  return column;
}

RowColumn MeanColumn(BenchQuantity quantity, const std::string& suffix, std::optional<double> QuantityError::*member) {
  return {NameOf(quantity) + suffix,
          [=](const BenchRow& row) {
            const auto& error = row.ErrorOf(quantity);
            return error && (*error).*member ? FormatExactly(*((*error).*member)) : "";
          },
          [=](BenchRow& row, const std::string& text) {
            if (text.empty()) return true;
            return Of(row, quantity) && Parse(text, ((*Of(row, quantity)).*member).emplace());
          },
          "a number, or nothing"};
}

RowColumn SketchColumn(BenchQuantity quantity) {
  return {std::string(NameOf(quantity)) + "Sketch",
          [=](const BenchRow& row) {
            std::string text;
            if (row.ErrorOf(quantity))
              for (const double value : row.ErrorOf(quantity)->sketch)
                text += (text.empty() ? "" : " ") + FormatValue(value, 8);
            return text;
          },
          [=](BenchRow& row, const std::string& text) {
            std::istringstream words(text);
            for (std::string word; words >> word;)
              if (!Of(row, quantity) || !Parse(word, Of(row, quantity)->sketch.emplace_back())) return false;
            return true;
          },
          "numbers with spaces between, or nothing"};
}

std::vector<RowColumn> MakeColumns() {
  std::vector<RowColumn> columns = {TextColumn("scene", &BenchRow::scene),
                                    TextColumn("sceneHash", &BenchRow::scene_hash),
                                    TextColumn("method", &BenchRow::method),
                                    TextColumn("settings", &BenchRow::settings),
                                    TextColumn("truth", &BenchRow::truth),
                                    OptionalCountColumn("budget", &BenchRow::budget),
                                    OptionalCountColumn("seed", &BenchRow::seed),
                                    CountColumn("repeat", &BenchRow::repeat),
                                    AmountColumn("wallSeconds", &BenchRow::wall_seconds),
                                    AmountColumn("cpuSeconds", &BenchRow::cpu_seconds),
                                    AmountColumn("rays", &BenchRow::rays),
                                    TextColumn("endReason", &BenchRow::end_reason)};
  for (const BenchQuantity quantity : kBenchQuantities) {
    columns.push_back(RmsColumn(quantity));
    columns.push_back(ErrorColumn(quantity, "Max", &QuantityError::largest));
    columns.push_back(ErrorColumn(quantity, "Relative", &QuantityError::relative));
    columns.push_back(MeanColumn(quantity, "MeanZ", &QuantityError::mean_z));
    columns.push_back(MeanColumn(quantity, "MeanZ2", &QuantityError::mean_z2));
    columns.push_back(ErrorColumn(quantity, "TruthRms", &QuantityError::truth_rms));
    columns.push_back(SketchColumn(quantity));
  }
  columns.push_back(CountColumn("threads", &BenchRow::threads));
  columns.push_back(TextColumn("processor", &BenchRow::processor));
  columns.push_back(CountColumn("processors", &BenchRow::processors));
  columns.push_back(TextColumn("client", &BenchRow::client));
  columns.push_back(TextColumn("server", &BenchRow::server));
  columns.push_back(TextColumn("date", &BenchRow::date));
  return columns;
}

}  // namespace

const std::vector<RowColumn>& RowColumns() {
  static const auto& columns = *new std::vector<RowColumn>(MakeColumns());
  return columns;
}

std::string RowHeader() {
  std::string text;
  for (const RowColumn& column : RowColumns()) text += (text.empty() ? "" : ",") + column.name;
  return text + '\n';
}

std::string RowText(const BenchRow& row) {
  std::string text;
  for (const RowColumn& column : RowColumns()) text += CsvText(column.write(row)) + ',';
  text.back() = '\n';
  return text;
}

}  // namespace flatlight
