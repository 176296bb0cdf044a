#include "engine/core/text_file.hpp"

#include <filesystem>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace handhold::io_text_file_test {
namespace {

namespace fs = std::filesystem;

class TextFile : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  (std::string("handhold_text_file_") +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    auto count_entries() const {
        return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
    }

    fs::path folder_;
};

TEST_F(TextFile, ReturnsEveryByteThatWasWritten) {
    std::string bytes;
    for (int i = 0; i < 256; ++i) {
        bytes += static_cast<char>(i);
    }
    for (const std::string& text : {bytes, std::string(), std::string("\r\n\n\0x", 5)}) {
        ASSERT_FALSE(write_file_atomically(folder_ / "a", text));
        const Result<std::string> read = read_file(folder_ / "a");
        ASSERT_TRUE(read.ok());
        EXPECT_EQ(read.value(), text);
    }
    EXPECT_EQ(count_entries(), 1);  // no temporary file is left
}

TEST_F(TextFile, FailedWriteLeavesNothingBehind) {
    fs::create_directories(folder_ / "is_a_folder" / "not_empty");
    const std::optional<FileError> error = write_file_atomically(folder_ / "is_a_folder", "text");
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->file, (folder_ / "is_a_folder").string());
    EXPECT_TRUE(write_file_atomically(folder_ / "absent" / "a", "text").has_value());
    EXPECT_EQ(count_entries(), 1);
}

TEST_F(TextFile, RefusesAbsentFolderDeviceAndTooLarge) {
    ASSERT_FALSE(write_file_atomically(folder_ / "a", "12345"));
    EXPECT_TRUE(read_file(folder_ / "a", 5).ok());
    EXPECT_FALSE(read_file(folder_ / "a", 4).ok());
    EXPECT_FALSE(read_file(folder_ / "absent").ok());
    EXPECT_FALSE(read_file(folder_).ok());
    EXPECT_FALSE(read_file("/dev/zero").ok());
    EXPECT_EQ(read_file(folder_ / "absent").error().file, (folder_ / "absent").string());
}

TEST_F(TextFile, LinksAreFollowedAndStay) {
    ASSERT_FALSE(write_file_atomically(folder_ / "target", "old"));
    fs::create_symlink("target", folder_ / "link");
    ASSERT_FALSE(write_file_atomically(folder_ / "link", "new"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(read_file(folder_ / "target").value(), "new");
    fs::create_symlink("nowhere", folder_ / "dangling");
    EXPECT_TRUE(write_file_atomically(folder_ / "dangling", "new").has_value());
    EXPECT_TRUE(fs::is_symlink(folder_ / "dangling"));
    EXPECT_FALSE(fs::exists(folder_ / "nowhere"));
}

TEST_F(TextFile, PipesAreRefusedAndStay) {
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    EXPECT_TRUE(write_file_atomically(folder_ / "pipe", "text").has_value());
    EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
    fs::create_symlink("pipe", folder_ / "link");
    EXPECT_TRUE(write_file_atomically(folder_ / "link", "text").has_value());
    EXPECT_EQ(count_entries(), 2);
}

TEST_F(TextFile, DevicesAreWrittenToAndStay) {
    EXPECT_FALSE(write_file_atomically("/dev/null", "text"));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    fs::create_symlink("/dev/null", folder_ / "link");
    EXPECT_FALSE(write_file_atomically(folder_ / "link", "text"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
}

TEST_F(TextFile, FullDiskIsNamed) {
    const std::optional<FileError> error = write_file_atomically("/dev/full", "text");
    ASSERT_TRUE(error.has_value());
    EXPECT_NE(error->message().find("No space left on device"), std::string::npos);
}

TEST_F(TextFile, ReplacedFileKeepsItsPermissions) {
    ASSERT_FALSE(write_file_atomically(folder_ / "a", "secret"));
    fs::permissions(folder_ / "a", fs::perms::owner_read | fs::perms::owner_write);
    ASSERT_FALSE(write_file_atomically(folder_ / "a", "new secret"));
    EXPECT_EQ(fs::status(folder_ / "a").permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
}

}  // namespace
}  // namespace handhold::io_text_file_test
