#include "io/program_file.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

namespace kerf::io {
namespace {

class ProgramFileTest : public testing::Test {
 protected:
  ProgramFileTest() {
    EXPECT_NE(mkdtemp(folder_.data()), nullptr);
    setenv("XDG_STATE_HOME", folder_.c_str(), 1);
  }
  ~ProgramFileTest() override {
    unsetenv("XDG_STATE_HOME");
    std::filesystem::remove_all(folder_);
  }
  [[nodiscard]] std::string path() const { return folder_ + "/part.nc"; }
  void write(std::size_t lines) const {
    std::ofstream file(path(), std::ios::binary);
    for (std::size_t line = 1; line <= lines; ++line) file << "G1X" << line << "F100\n";
  }

  std::string folder_ = std::filesystem::temp_directory_path() / "kerf-program-file-XXXXXX";
};

constexpr std::size_t kManyLines = 500'000;

TEST_F(ProgramFileTest, ShortAndLongFilesReadAlike) {
  for (const std::size_t lines : {std::size_t{10}, kManyLines}) {
    write(lines);
    const auto file = ProgramFile::load(path());
    ASSERT_TRUE(file);
    const auto& program = *file->program();
    EXPECT_EQ(program.name(), path());
    EXPECT_EQ(program.size_bytes() > kMostHeldBytes, lines == kManyLines);
    ASSERT_EQ(program.line_count(), lines);
    const auto last = static_cast<std::uint32_t>(lines);
    EXPECT_EQ(program.line(last)->text, "G1X" + std::to_string(lines) + "F100");
  }
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void pack_with_gzip(const std::string& from, const std::string& to) {
  const std::string text = text_of(from);
  const gzFile file = gzopen(to.c_str(), "wb");
  EXPECT_EQ(gzwrite(file, text.data(), static_cast<unsigned>(text.size())), static_cast<int>(text.size()));
  gzclose(file);
}

/// In two frames, as tools write that pack on several cores.
void pack_with_zstd(const std::string& from, const std::string& to) {
  const std::string text = text_of(from);
  std::ofstream file(to, std::ios::binary);
  for (const std::string_view part :
       {std::string_view{text}.substr(0, text.size() / 2), std::string_view{text}.substr(text.size() / 2)}) {
    std::string packed(ZSTD_compressBound(part.size()), '\0');
    packed.resize(ZSTD_compress(packed.data(), packed.size(), part.data(), part.size(), 1));
    file << packed;
  }
}

TEST_F(ProgramFileTest, PackedFilesReadAsWhatTheyUnpackTo) {
  const std::string packed = folder_ + "/packed.nc";
  for (const std::size_t lines : {std::size_t{10}, kManyLines}) {
    for (const auto pack : {&pack_with_gzip, &pack_with_zstd}) {
      write(lines);
      const auto plain = ProgramFile::load(path());
      ASSERT_TRUE(plain);
      pack(path(), packed);
      const auto file = ProgramFile::load(packed);
      ASSERT_TRUE(file) << explain(file.error(), packed);
      EXPECT_EQ(file->program()->line_count(), lines);
      EXPECT_EQ(file->program()->hash(), plain->program()->hash());
      // Cut short it is no program, however far it can be unpacked.
      std::filesystem::resize_file(packed, std::filesystem::file_size(packed) - 3);
      const auto cut = ProgramFile::load(packed);
      ASSERT_FALSE(cut);
      EXPECT_THAT(explain(cut.error(), packed), testing::HasSubstr("damaged or cut short"));
    }
  }
}

TEST_F(ProgramFileTest, WhoeverCutsTheFileShortDoesNotTouchTheJob) {
  write(kManyLines);
  const auto file = ProgramFile::load(path());
  ASSERT_TRUE(file);
  std::filesystem::resize_file(path(), 0);
  EXPECT_EQ(file->program()->line(kManyLines / 2)->text, "G1X250000F100");
  write(20);
  EXPECT_EQ(file->program()->line(kManyLines)->text, "G1X500000F100");
  // The copy has no name that anybody would have to remove.
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    EXPECT_TRUE(entry.is_directory() || entry.path() == path()) << entry.path();
  }
}

TEST_F(ProgramFileTest, PutsATextTogether) {
  for (const std::size_t lines : {std::size_t{10}, kManyLines}) {
    const auto file = ProgramFile::assemble("rest of part.nc", [lines](const ProgramFile::Put& put) {
      put("G21\n");
      for (std::size_t line = 2; line <= lines; ++line) put("G1X" + std::to_string(line) + "F100\n");
    });
    ASSERT_TRUE(file);
    EXPECT_EQ(file->program()->name(), "rest of part.nc");
    EXPECT_EQ(file->program()->line(1)->text, "G21");
    EXPECT_EQ(file->program()->line_count(), lines);
    EXPECT_EQ(file->program()->line(static_cast<std::uint32_t>(lines))->text, "G1X" + std::to_string(lines) + "F100");
  }
}

TEST_F(ProgramFileTest, TakesAPipe) {
  ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
  std::thread writer([this] { write(1000); });
  const auto file = ProgramFile::load(path());
  writer.join();
  ASSERT_TRUE(file);
  EXPECT_EQ(file->program()->line_count(), 1000U);
}

TEST_F(ProgramFileTest, SaysWhatIsWrong) {
  const auto sentence = [](const std::string& path) {
    const auto file = ProgramFile::load(path);
    return file ? std::string() : explain(file.error(), path);
  };
  EXPECT_NE(sentence(path()).find("There is no file"), std::string::npos);
  EXPECT_NE(sentence(folder_).find("is a folder"), std::string::npos);
  EXPECT_NE(sentence("/dev/zero").find("is a device"), std::string::npos);
  write(0);
  EXPECT_NE(sentence(path()).find("holds no line"), std::string::npos);
  std::ofstream(path(), std::ios::binary) << std::string(2 * kMostHeldBytes, ' ');
  EXPECT_NE(sentence(path()).find("holds no line"), std::string::npos);
}

}  // namespace
}  // namespace kerf::io
