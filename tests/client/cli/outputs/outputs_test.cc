// SPDX-License-Identifier: Apache-2.0
#include "client/cli/outputs/outputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "client/cli/outputs/atomic_file.h"
#include "client/cli/outputs/picture_writer.h"
#include "client/cli/outputs/tone_mapping.h"

namespace flatlight {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string Message(const absl::Status& status) {
  return std::string(status.message().data(), status.message().size());
}

class OutputsTest : public ::testing::Test {
 protected:
  OutputsTest() {
    std::string folder = ::testing::TempDir() + "flatlight-outputs-XXXXXX";
    folder_ = mkdtemp(folder.data());
  }
  ~OutputsTest() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  std::ptrdiff_t FileCount() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }
  static std::string Read(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  fs::path folder_;
};

TEST_F(OutputsTest, AFileIsThereWholeAfterCommit) {
  {
    auto file = AtomicFile::Create(Path("a"));
    ASSERT_TRUE(file.ok());
    ASSERT_TRUE((*file)->Write("half").ok());
    EXPECT_FALSE(fs::exists(Path("a")));
  }
  EXPECT_EQ(FileCount(), 0);
  ASSERT_TRUE(WriteFileAtomically(Path("a"), "one").ok());
  ASSERT_TRUE(WriteFileAtomically(Path("a"), "two").ok());
  EXPECT_EQ(Read(Path("a")), "two");
  EXPECT_EQ(FileCount(), 1);
  const mode_t mask = umask(0);
  umask(mask);
  struct stat info {};
  ASSERT_EQ(stat(Path("a").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0666 & ~mask);
}

TEST_F(OutputsTest, AFileKeepsItsPermissions) {
  std::ofstream(Path("a")) << "old";
  for (const mode_t mode : {0600U, 0664U}) {
    ASSERT_EQ(chmod(Path("a").c_str(), mode), 0);
    ASSERT_TRUE(WriteFileAtomically(Path("a"), "new").ok());
    struct stat info {};
    ASSERT_EQ(stat(Path("a").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, mode);
  }
  ASSERT_EQ(chmod(Path("a").c_str(), 0400), 0);
  // Root may write to it all the same.
  EXPECT_EQ(WriteFileAtomically(Path("a"), "newer").ok(), access(Path("a").c_str(), W_OK) == 0);
}

TEST_F(OutputsTest, ALinkIsFollowed) {
  std::ofstream(Path("target")) << "old";
  fs::create_symlink("target", Path("link"));
  ASSERT_TRUE(WriteFileAtomically(Path("link"), "new").ok());
  EXPECT_TRUE(fs::is_symlink(Path("link")));
  EXPECT_EQ(Read(Path("target")), "new");
}

TEST_F(OutputsTest, PlacesThatCannotBeWrittenAreNamed) {
  EXPECT_THAT(Message(CheckWritable(Path("no/a"))), HasSubstr(Path("no")));
  std::ofstream(Path("file")) << "x";
  EXPECT_THAT(Message(CheckWritable(Path("file/a"))), HasSubstr("file"));
  EXPECT_THAT(Message(CheckWritable(folder_.string())), HasSubstr("folder"));
  EXPECT_THAT(Message(CheckWritable("/dev/full")), HasSubstr("not a regular file"));
  EXPECT_TRUE(CheckWritable("new-file-in-the-current-folder").ok());
}

TEST_F(OutputsTest, WhenThereIsNoRoomTheOldFileStays) {
  signal(SIGXFSZ, SIG_IGN);
  std::ofstream(Path("a")) << "old";
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{1000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const absl::Status status = WriteFileAtomically(Path("a"), std::string(5000, 'x'));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_THAT(Message(status), HasSubstr(Path("a") + " could not be written: File too large"));
  EXPECT_EQ(Read(Path("a")), "old");
  EXPECT_EQ(FileCount(), 1);
}

TEST_F(OutputsTest, EndingsPickTheForm) {
  const auto outputs = PlanOutputs({Path("a.JSON"), "-", Path("b.csv"), Path("c.npy")});
  ASSERT_TRUE(outputs.ok()) << outputs.status();
  EXPECT_EQ((*outputs)[0].form, OutputForm::kJson);
  EXPECT_EQ((*outputs)[1].path, "-");
  EXPECT_EQ((*outputs)[3].form, OutputForm::kNpy);
  EXPECT_TRUE(WritesToStandardOutput(*outputs));
  EXPECT_FALSE(PlanOutputs({Path("a.tiff")}).ok());
  EXPECT_FALSE(PlanOutputs({Path("json")}).ok());
  EXPECT_FALSE(PlanOutputs({""}).ok());
  EXPECT_FALSE(PlanOutputs({"-", "-"}).ok());
}

TEST_F(OutputsTest, OneFailureDoesNotLoseTheRest) {
  v1::RenderResult result;
  result.set_scene("s");
  const std::vector<Output> outputs = {{Path("no/a.json"), OutputForm::kJson}, {Path("b.json"), OutputForm::kJson}};
  EXPECT_THAT(Message(WriteOutputs(result, outputs, [] { return false; })), HasSubstr("a.json"));
  EXPECT_THAT(Read(Path("b.json")), HasSubstr("\"scene\": \"s\""));
}

TEST_F(OutputsTest, AnInterruptionEndsTheWriting) {
  v1::RenderResult result;
  v1::ProbeResult& probe = *result.add_probes();
  constexpr int kPoints = 20000;
  probe.set_count(kPoints);
  probe.set_channels(1);
  for (int i = 0; i < kPoints; ++i) probe.add_irradiance(i);
  const std::vector<Output> outputs = {{Path("a.csv"), OutputForm::kCsv}, {Path("b.npy"), OutputForm::kNpy}};
  int asked = 0, last = 0;
  const auto interrupted = [&asked, &last] { return ++asked >= last; };
  last = 1 << 30;
  ASSERT_TRUE(WriteOutputs(result, outputs, interrupted).ok());
  const int all = asked;
  EXPECT_GT(all, 2 * (kPoints / 5000));
  std::ptrdiff_t most = 0;
  for (last = 1; last <= all; ++last) {
    for (const Output& output : outputs) fs::remove(output.path);
    asked = 0;
    const absl::Status status = WriteOutputs(result, outputs, interrupted);
    EXPECT_EQ(status.code(), absl::StatusCode::kCancelled);
    EXPECT_FALSE(fs::exists(Path("b.npy")));
    EXPECT_EQ(FileCount(), fs::exists(Path("a.csv")) ? 1 : 0);  // No temporaries.
    most = std::max(most, FileCount());
    EXPECT_LE(asked, last + 1) << "it goes on";
  }
  EXPECT_EQ(most, 1);
}

TEST(Pictures, RowsAreStackedInColour) {
  v1::RenderResult result;
  for (int count : {1, 2}) {
    v1::ProbeResult& probe = *result.add_probes();
    probe.set_count(static_cast<unsigned>(count));
    probe.set_channels(1);
    for (int i = 0; i < count; ++i) probe.add_irradiance(count + i);
  }
  const Picture stacked = StackedColour(PicturesOf(result));
  EXPECT_EQ(stacked.width, 2);
  EXPECT_EQ(stacked.height, 2);
  EXPECT_THAT(stacked.pixels, ::testing::ElementsAre(1, 1, 1, 0, 0, 0, 2, 2, 2, 3, 3, 3));
}

v1::RenderResult PictureResult() {
  v1::RenderResult result;
  v1::ProbeResult& probe = *result.add_probes();
  probe.set_count(6);
  probe.set_channels(1);
  probe.set_width(2);
  probe.set_height(3);
  for (int i = 0; i < 6; ++i) probe.add_irradiance(i);
  return result;
}

TEST(Pictures, TheLowestRowIsTheLast) {
  const std::vector<Picture> pictures = PicturesOf(PictureResult());
  ASSERT_EQ(pictures.size(), 1U);
  EXPECT_EQ(pictures[0].width, 2);
  EXPECT_EQ(pictures[0].height, 3);
  EXPECT_THAT(pictures[0].pixels, ::testing::ElementsAre(4, 5, 2, 3, 0, 1));
  EXPECT_TRUE(HasPictures(PictureResult()));
  EXPECT_FALSE(HasPictures(v1::RenderResult()));
}

TEST(ToneMapping, KeepsOrderHueAndRange) {
  Picture picture{"p", 100, 1, 3, {}};
  for (int i = 0; i < 100; ++i) {
    const float y = 1e-3F * static_cast<float>(std::pow(1.1, i));
    picture.pixels.insert(picture.pixels.end(), {y, 0.5F * y, 0});
  }
  const Picture mapped = ToneMapped(picture);
  ASSERT_EQ(mapped.pixels.size(), picture.pixels.size());
  for (std::size_t i = 0; i < mapped.pixels.size(); i += 3) {
    EXPECT_GE(mapped.pixels[i], 0);
    EXPECT_LE(mapped.pixels[i], 1);
    EXPECT_EQ(mapped.pixels[i + 2], 0);
    EXPECT_GT(mapped.pixels[i], mapped.pixels[i + 1]);
    EXPECT_GE(mapped.pixels[i], i > 0 ? mapped.pixels[i - 3] : 0);
  }
  EXPECT_EQ(mapped.pixels[297], 1) << "the brightest is white";
}

// The light's unit is free: a picture and one a thousand times as bright look the same.
TEST(ToneMapping, AdaptsToTheLight) {
  Picture dim{"p", 50, 1, 1, {}}, bright{"p", 50, 1, 1, {}};
  for (int i = 0; i < 50; ++i) {
    dim.pixels.push_back(static_cast<float>(i));
    bright.pixels.push_back(1024 * static_cast<float>(i));
  }
  EXPECT_THAT(ToneMapped(bright).pixels, ::testing::Pointwise(::testing::FloatNear(1e-6F), ToneMapped(dim).pixels));
  const Picture dark{"p", 3, 1, 1, {0, 0, 0}};
  EXPECT_EQ(ToneMapped(dark).pixels, dark.pixels);
}

}  // namespace
}  // namespace flatlight
