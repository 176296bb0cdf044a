#include "engine/io/file_name.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace handhold::io_file_name_test {
namespace {

namespace fs = std::filesystem;

// Pieces of names that lead out of a folder; random names seldom contain them.
rc::Gen<std::string> hostile_names() {
    const auto piece = rc::gen::oneOf(
        rc::gen::element<std::string>("..", "/", "\\", ".", "~", "%", "%2F", "..\\", "C:", "\0",
                                      "\n", "\x1b", " ", "-", "\xe2\x80\xae", "\xff", "a", "é"),
        rc::gen::arbitrary<std::string>());
    return rc::gen::map(rc::gen::container<std::vector<std::string>>(piece),
                        [](const std::vector<std::string>& pieces) {
                            std::string name;
                            for (const std::string& part : pieces) {
                                name += part;
                            }
                            return name;
                        });
}

TEST(FileName, OrdinaryNamesStay) {
    for (const std::string name : {"node", "hab_2", "Module 3", "Küche", "a.b", "x-1", "(old)"}) {
        EXPECT_EQ(file_name(name), name);
    }
}

TEST(FileName, NamesThatLeadElsewhereAreEncoded) {
    EXPECT_EQ(file_name("../../x"), "%2E.%2F..%2Fx");
    EXPECT_EQ(file_name("/etc/passwd"), "%2Fetc%2Fpasswd");
    EXPECT_EQ(file_name("."), "%2E");
    EXPECT_EQ(file_name(".."), "%2E%2E");
    EXPECT_EQ(file_name(""), "%");
    EXPECT_EQ(file_name("-rf"), "%2Drf");
    EXPECT_EQ(file_name("a\nb"), "a%0Ab");
    EXPECT_EQ(file_name(std::string("a\0b", 3)), "a%00b");
}

TEST(FileName, LongNamesDifferByTheirHash) {
    const std::string a = file_name(std::string(5000, 'a') + "1");
    const std::string b = file_name(std::string(5000, 'a') + "2");
    EXPECT_EQ(a.size(), k_max_file_name_bytes);
    EXPECT_NE(a, b);
}

RC_GTEST_PROP(FileName, AnyNameIsOneFileInsideTheFolder, ()) {
    const std::string name = file_name(*hostile_names());
    const fs::path folder = "/out/run";
    const fs::path file = folder / (name + ".png");
    RC_ASSERT(file.lexically_normal() == file);
    RC_ASSERT(file.parent_path() == folder);
    RC_ASSERT(!name.empty() && name.size() <= k_max_file_name_bytes);
    for (const char c : name) {
        RC_ASSERT(static_cast<unsigned char>(c) >= 0x20U && c != 0x7F && c != '/' && c != '\\');
    }
}

RC_GTEST_PROP(FileName, DifferentNamesAreDifferentFiles, ()) {
    const std::string a = *hostile_names();
    const std::string b = *hostile_names();
    RC_ASSERT((file_name(a) == file_name(b)) == (a == b));
}

}  // namespace
}  // namespace handhold::io_file_name_test
