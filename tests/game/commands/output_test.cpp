// Output: folders are locked, and commands to copy are quoted.
#include <cstdio>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include "game/commands/output_folder.hpp"
#include "game/commands/play_files.hpp"
#include "game/play/shell_word.hpp"

namespace handhold::output_test {
namespace {

namespace fs = std::filesystem;

TEST(OutputFolder, SecondHolderIsRefusedUntilTheFirstEnds) {
    const fs::path path =
        fs::path(testing::TempDir()) / ("handhold_output_" + std::to_string(getpid()));
    {
        const Result<OutputFolder> first = OutputFolder::open(path / "a");
        ASSERT_TRUE(first.ok());
        EXPECT_FALSE(OutputFolder::open(path / "a").ok());
        EXPECT_TRUE(OutputFolder::open(path / "b").ok());
    }
    EXPECT_TRUE(OutputFolder::open(path / "a").ok());
    EXPECT_TRUE(fs::is_empty(path / "a"));
    fs::remove_all(path);
}

// The word as a shell reads it.
std::string read_by_shell(const char* shell, const std::string& word) {
    const std::string script = "printf %s " + word;
    // The script reaches the shell in an environment variable, so no other quoting is involved.
    setenv("HANDHOLD_SCRIPT", script.c_str(), 1);
    const std::string command = std::string(shell) + " -c \"$HANDHOLD_SCRIPT\"";
    std::FILE* const pipe = popen(command.c_str(), "r");
    std::string out;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
        out += static_cast<char>(c);
    }
    pclose(pipe);
    return out;
}

TEST(ShellWord, PlainWordsStay) {
    EXPECT_EQ(shell_word("station"), "station");
    EXPECT_EQ(shell_word("/tmp/a-b_c.csv"), "/tmp/a-b_c.csv");
    EXPECT_EQ(shell_word(""), "''");
}

TEST(ShellWord, PosixShellReadsPrintableWordsBack) {
    for (const std::string word : {"a b", "$(rm -rf ~)", "`id`", "it's", "a;b&c|d>e<f", "\"x\"",
                                   "~", "*", "!!", "#", "\\", "é ü", "-n"}) {
        EXPECT_EQ(read_by_shell("sh", shell_word(word)), word);
    }
}

TEST(ShellWord, ControlCharactersAreNeverPrinted) {
    const std::string word = "a\nb\x1b[31m'\\1";
    EXPECT_EQ(shell_word(word), "$'a\\012b\\033[31m\\'\\\\1'");
    EXPECT_EQ(read_by_shell("bash", shell_word(word)), word);
}

RC_GTEST_PROP(ShellWord, BashReadsAnyTextBack, (const std::string& text)) {
    const std::string ended = text.substr(0, text.find('\0'));
    RC_ASSERT(read_by_shell("bash", shell_word(text)) == ended);
}

TEST(ReplayCommand, IsQuotedForAShell) {
    PlayOptions options;
    options.scene = "my scene.json";
    options.record = "-out;reboot.csv";
    EXPECT_EQ(replay_command(options, "hall 'A'", 90.0),
              "handhold run --scene 'my scene.json' --spawn 'hall '\\''A'\\''' --players 1 "
              "--input='-out;reboot.csv'");
}

}  // namespace
}  // namespace handhold::output_test
