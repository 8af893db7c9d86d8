// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/bench_report.h"

#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <system_error>

namespace flatlight {
namespace {

void WriteRow(std::ofstream& file, const std::vector<std::string>& row) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    std::string cell = row[i];
    if (cell.find_first_of(",\"") != std::string::npos) {
      for (std::size_t k = 0; (k = cell.find('"', k)) != std::string::npos; k += 2) cell.insert(k, 1, '"');
      cell = '"' + cell + '"';
    }
    file << (i > 0 ? "," : "") << cell;
  }
  file << '\n';
}

}  // namespace

double ThreadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Quartiles QuartilesOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {at(0.25), at(0.5), at(0.75)};
}

std::string MachineName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string BuildName() {
  std::ifstream program("/proc/self/exe", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(program), {}};
  if (bytes.empty()) return FLATLIGHT_VERSION;
  std::array<unsigned char, SHA256_DIGEST_LENGTH> hash{};
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), hash.data());
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), " (%02x%02x%02x%02x)", hash[0], hash[1], hash[2], hash[3]);
  return std::string(FLATLIGHT_VERSION) + text.data();
}

std::string Short(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

void BenchTable::Print() const {
  std::vector<std::size_t> widths(columns_.size());
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    widths[i] = columns_[i].size();
    for (const auto& row : rows_) widths[i] = std::max(widths[i], row[i].size());
  }
  const auto print = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += row[i] + std::string(widths[i] + 2 - row[i].size(), ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    std::printf("%s\n", line.c_str());
  };
  print(columns_);
  for (const auto& row : rows_) print(row);
  std::fflush(stdout);
}

bool BenchTable::WriteCsv(const std::string& path) const {
  std::error_code failed;  // Then the file cannot be written either.
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), failed);
  std::ofstream file(path);
  std::vector<std::string> first = {"machine", "build"};
  first.insert(first.end(), columns_.begin(), columns_.end());
  WriteRow(file, first);
  const std::string machine = MachineName();
  const std::string build = BuildName();
  for (const auto& row : rows_) {
    std::vector<std::string> whole = {machine, build};
    whole.insert(whole.end(), row.begin(), row.end());
    WriteRow(file, whole);
  }
  file.close();
  return !file.fail();
}

bool BenchTable::Report(const std::string& path) const {
  Print();
  const bool written = WriteCsv(path);
  if (!written) std::fprintf(stderr, "%s could not be written\n", path.c_str());
  return written;
}

}  // namespace flatlight
