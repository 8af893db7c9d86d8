// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "client/cli/bench/rows/row_columns.h"
#include "client/cli/bench/rows/row_file.h"
#include "client/cli/bench/rows/row_reader.h"
#include "tests/client/cli/bench/sample_rows.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

BenchRow FullRow() {
  BenchRow row = SampleRow("a \"b\", c\nd", 64, 7, 0.1, 1.0 / 3);
  row.errors[0]->sketch = {1e-17, -2.5, 0};
  row.errors[2] = QuantityError{1, 2, 3, {}, {}, 0.5, {}};
  return row;
}

std::string MessageOf(const std::string& bytes) {
  const auto rows = RowsFromCsv(bytes, "b.csv");
  EXPECT_FALSE(rows.ok());
  return rows.ok() ? "" : std::string(rows.status().message().data(), rows.status().message().size());
}

TEST(Rows, ComeBackAsTheyWere) {
  const auto rows = RowsFromCsv(RowHeader() + RowText(FullRow()) + RowText(ExactRow("e", 3, 1e-5)), "b.csv");
  ASSERT_TRUE(rows.ok()) << rows.status();
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ(RowText((*rows)[0]), RowText(FullRow()));
  EXPECT_EQ(RowText((*rows)[1]), RowText(ExactRow("e", 3, 1e-5)));
  EXPECT_EQ((*rows)[0].scene, "a \"b\", c\nd");
  EXPECT_EQ((*rows)[0].ErrorOf(BenchQuantity::kIrradiance)->rms, 1.0 / 3);
  EXPECT_EQ((*rows)[0].ErrorOf(BenchQuantity::kIrradiance)->sketch, (std::vector<double>{1e-17, -2.5, 0}));
  EXPECT_FALSE((*rows)[0].ErrorOf(BenchQuantity::kGradient));
  EXPECT_FALSE((*rows)[1].budget || (*rows)[1].seed);
}

TEST(Rows, OrderOfColumnsAndKindOfLineBreakDoNotMatter) {
  std::string header, line;
  for (auto column = RowColumns().rbegin(); column != RowColumns().rend(); ++column) {
    header += (header.empty() ? "" : ",") + column->name;
    line +=
        (line.empty() ? "" : ",") + std::string("\"") + column->write(SampleRow("s", 16, 1, 2, 3)).substr(0, 11) + '"';
  }
  line.replace(line.find("a processor"), 11, "p");
  const auto rows = RowsFromCsv(header + "\r\n" + line + "\r\n", "b.csv");
  ASSERT_TRUE(rows.ok()) << rows.status();
  EXPECT_EQ((*rows)[0].scene, "s");
  EXPECT_EQ((*rows)[0].processor, "p");
}

TEST(Rows, AnEmptyFileHasNone) {
  EXPECT_TRUE(RowsFromCsv("", "b.csv")->empty());
  EXPECT_TRUE(RowsFromCsv(RowHeader(), "b.csv")->empty());
}

TEST(Rows, DamageIsToldWithLineAndColumn) {
  const std::string row = RowText(SampleRow("s", 16, 1, 2, 3)), good = RowHeader() + row;
  const auto at = [](std::size_t line, std::size_t column) {
    return "b.csv: line " + std::to_string(line) + ", column " + std::to_string(column) + ": ";
  };
  // Cut short: in the middle of a value, of a row, of a line break.
  EXPECT_THAT(MessageOf(good.substr(0, good.size() - 1)),
              HasSubstr(at(2, row.size()) + "the file ends in the middle of a row"));
  EXPECT_THAT(MessageOf(RowHeader() + row.substr(0, 5)), HasSubstr(at(2, 6) + "the file ends"));
  EXPECT_THAT(MessageOf(RowHeader() + "s,h,m\n" + row), HasSubstr(at(2, 5) + "the row ends with value 3; must have"));
  std::string bad = good;
  bad.replace(good.find(",16,") + 1, 2, "x");
  EXPECT_THAT(MessageOf(bad), HasSubstr(at(2, row.find(",16,") + 2) + "budget is 'x'; must be a whole number"));
  bad = good;
  bad.replace(good.rfind(",2,"), 3, ",-2,");
  EXPECT_THAT(MessageOf(bad), HasSubstr("threads is '-2'"));
  bad = good + "\"s,16,\n1";
  EXPECT_THAT(MessageOf(bad), StartsWith(at(3, 1) + "the quotation mark is never closed"));
  EXPECT_THAT(MessageOf(RowHeader() + "\"s\"x,"), StartsWith(at(2, 4) + "a comma or a line break should follow"));
  EXPECT_THAT(MessageOf(RowHeader() + "s\"x,"), StartsWith(at(2, 2) + "a quotation mark inside"));
  EXPECT_THAT(MessageOf(RowHeader() + std::string("s\0x,", 4)), StartsWith(at(2, 2) + "a control character"));
  EXPECT_THAT(MessageOf("scene,scene,lunch\n"), HasSubstr(at(1, 7) + "the column scene is there twice"));
  EXPECT_THAT(MessageOf("scene,scene,lunch\n"), HasSubstr(at(1, 13) + "'lunch' is no column"));
  EXPECT_THAT(MessageOf("scene\n"), HasSubstr(at(1, 1) + "the column sceneHash is missing"));
}

TEST(Rows, NumbersThatCannotBe) {
  for (const char* number : {"nan", "inf", "1e999", "0x10", "", " 1", "1 "}) {
    BenchRow row = SampleRow("s", 16, 1, 0.125, 3);
    std::string text = RowHeader() + RowText(row);
    text.replace(text.find(",0.125,") + 1, 5, number);
    EXPECT_THAT(MessageOf(text), HasSubstr("cpuSeconds is '" + std::string(number) + "'; must be a number from 0"));
  }
  // An RMS that is missing, of a quantity whose other values are there.
  std::string text = RowHeader() + RowText(SampleRow("s", 16, 1, 2, 0.25));
  text.replace(text.find(",0.25,") + 1, 4, "");
  EXPECT_THAT(MessageOf(text), HasSubstr("irradianceMax is '0.75'"));
}

class RowFileTest : public ::testing::Test {
 protected:
  RowFileTest() {
    std::string folder = (std::filesystem::temp_directory_path() / "flatlight-rows-XXXXXX").string();
    folder_ = mkdtemp(folder.data());
    path_ = folder_ + "/b.csv";
  }
  ~RowFileTest() override { std::filesystem::remove_all(folder_); }

  std::string Bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  void Write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

  std::string folder_, path_;
};

TEST_F(RowFileTest, GrowsByRows) {
  {
    const auto file = RowFile::Open(path_);
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_FALSE(std::filesystem::exists(path_));  // Not before there is a row.
    EXPECT_TRUE((*file)->Append(FullRow()).ok());
    EXPECT_EQ(Bytes(), RowHeader() + RowText(FullRow()));
    EXPECT_TRUE((*file)->Append(FullRow()).ok());
  }
  const auto again = RowFile::Open(path_);
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ((*again)->rows().size(), 2U);
  EXPECT_TRUE((*again)->Append(FullRow()).ok());
  EXPECT_EQ(Bytes(), RowHeader() + RowText(FullRow()) + RowText(FullRow()) + RowText(FullRow()));
}

TEST_F(RowFileTest, AnEmptyFileGetsAHeader) {
  Write("");
  EXPECT_TRUE((*RowFile::Open(path_))->Append(FullRow()).ok());
  EXPECT_EQ(Bytes(), RowHeader() + RowText(FullRow()));
}

TEST_F(RowFileTest, OneWriterAtATime) {
  Write(RowHeader());
  const auto first = RowFile::Open(path_);
  ASSERT_TRUE(first.ok());
  const auto second = RowFile::Open(path_);
  EXPECT_THAT(second.status().ToString(), HasSubstr("another benchmark is writing to it"));
}

TEST_F(RowFileTest, RefusesWhatItCannotAppendTo) {
  Write("scene\nrubbish\n");
  EXPECT_THAT(RowFile::Open(path_).status().ToString(), HasSubstr("line 1, column 1: the column sceneHash is missing"));
  std::string header = RowHeader();
  header.replace(0, 15, "sceneHash,scene");
  Write(header);
  EXPECT_THAT(RowFile::Open(path_).status().ToString(), HasSubstr("another order"));
  EXPECT_THAT(RowFile::Open(folder_).status().ToString(), HasSubstr("could not be written"));
}

TEST_F(RowFileTest, NoHalfRowWhenThereIsNoRoom) {
  const auto file = RowFile::Open(path_);
  ASSERT_TRUE((*file)->Append(FullRow()).ok());
  const std::string before = Bytes();
  struct rlimit old {};
  getrlimit(RLIMIT_FSIZE, &old);
  const struct rlimit tight { before.size() + 10, old.rlim_max };
  std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &tight);
  const absl::Status status = (*file)->Append(FullRow());
  setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_THAT(status.ToString(), HasSubstr("could not be written: File too large"));
  EXPECT_EQ(Bytes(), before);
  EXPECT_TRUE((*file)->Append(FullRow()).ok());
  EXPECT_EQ(Bytes(), before + RowText(FullRow()));
}

TEST(Rows, OthersAreTold) {
  const BenchRow row = SampleRow("s", 16, 1, 2, 3);
  BenchRow other = row;
  EXPECT_EQ(OtherContext(other, row), "");
  other.server = "1+c";
  EXPECT_EQ(OtherContext(other, row), "the server's build is 1+c, not 1+b");
  other.threads = 1;
  EXPECT_THAT(OtherContext(other, row), HasSubstr("4 processors, 1 thread, not "));
  other = row;
  other.repeat = 1;
  EXPECT_TRUE(SamePoint(other, row));
  EXPECT_FALSE(SameRun(other, row));
  other.truth = "file";
  EXPECT_FALSE(SamePoint(other, row));
}

}  // namespace
}  // namespace flatlight
