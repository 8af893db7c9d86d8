// SPDX-License-Identifier: Apache-2.0
#include "client/cli/scenes/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <thread>

#include "client/cli/scenes/scene_upload.h"

namespace flatlight {
namespace {

using ::testing::HasSubstr;

std::string Message(const absl::Status& status) {
  return std::string(status.message().data(), status.message().size());
}

TEST(SceneArgument, FilesGalleryAndStandardInput) {
  EXPECT_EQ(ParseSceneArgument("gallery:penumbra")->name, "scenes/penumbra");
  EXPECT_EQ(ParseSceneArgument("-")->label, "standard input");
  EXPECT_EQ(ParseSceneArgument("a/b.json")->path, "a/b.json");
  EXPECT_FALSE(ParseSceneArgument("a/b.json")->from_server());
  for (const char* bad : {"", "gallery:", "gallery:../x"}) EXPECT_FALSE(ParseSceneArgument(bad).ok()) << bad;
}

TEST(ReadFile, UpToTheLimit) {
  const Interruption interruption;
  const std::string path = ::testing::TempDir() + "flatlight-scene-test";
  std::ofstream(path) << std::string(3000000, 'x');
  const auto bytes = ReadFile(path, "label", 3000000, interruption);
  ASSERT_TRUE(bytes.ok());
  EXPECT_EQ(bytes->size(), 3000000U);
  EXPECT_EQ(Message(ReadFile(path, "label", 2999999, interruption).status()),
            "label has 2.86 MiB; allowed are at most 2.86 MiB");
  std::remove(path.c_str());
  EXPECT_THAT(Message(ReadFile(path, "label", 10, interruption).status()),
              HasSubstr("label cannot be read: No such file"));
  EXPECT_THAT(Message(ReadFile("/tmp", "label", 10, interruption).status()), HasSubstr("folder"));
  EXPECT_THAT(Message(ReadFile("/dev/null", "label", 10, interruption).status()), HasSubstr("label is empty"));
}

class FifoTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0); }
  void TearDown() override { std::remove(path_.c_str()); }

  const std::string path_ = ::testing::TempDir() + "flatlight-fifo-" + std::to_string(getpid());
  const Interruption interruption_;
};

TEST_F(FifoTest, IsReadToItsEnd) {
  std::thread writer([this] { std::ofstream(path_) << std::string(200000, 'x'); });
  const auto bytes = ReadFile(path_, "label", 3000000, interruption_);
  writer.join();
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  EXPECT_EQ(bytes->size(), 200000U);
}

TEST_F(FifoTest, ASignalEndsTheWaitForItsWriter) {
  kill(getpid(), SIGINT);
  EXPECT_EQ(ReadFile(path_, "label", 3000000, interruption_).status().code(), absl::StatusCode::kCancelled);
}

// A pipe has no size; its reader stops when the limit is passed.
TEST(ReadFile, EndlessPipesAreRefused) {
  const Interruption interruption;
  EXPECT_THAT(Message(ReadFile("/dev/zero", "label", 5000000, interruption).status()), HasSubstr("more than 4.77 MiB"));
}

TEST(Sha256Hex, MatchesTheStandard) {  // FIPS 180-2, appendix B.1.
  EXPECT_EQ(Sha256Hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(DiagnosticLines, OneALineWithThePath) {
  v1::ValidateSceneResponse response;
  response.add_diagnostics()->set_path("plane.curves[3]");
  response.mutable_diagnostics(0)->set_message("zero\nlength");
  response.add_diagnostics()->set_message("no probes");
  response.set_more_diagnostics(2);
  EXPECT_EQ(DiagnosticLines({"a.json", "", "a.json"}, response),
            "a.json: plane.curves[3]: zero?length\na.json: no probes\na.json: 2 more mistakes");
}

}  // namespace
}  // namespace flatlight
