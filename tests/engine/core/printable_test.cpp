#include "engine/core/printable.hpp"

#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/core/result.hpp"

namespace handhold::io_printable_test {
namespace {

bool has_only_visible_characters(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = printable_length(text);
        if (length == 0) {
            return false;
        }
        text.remove_prefix(length);
    }
    return true;
}

std::size_t characters_of(std::string_view text) {
    std::size_t count = 0;
    for (const char c : text) {
        count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
    }
    return count;
}

TEST(Printable, PlainTextStays) {
    for (const std::string text : {"", "ship.json", "Größe 3 μm", "日本語", "\xF0\x9F\x9A\x80"}) {
        EXPECT_EQ(printable(text), text);
    }
}

TEST(Printable, ControlsAndInvisibleCharactersAreEscaped) {
    EXPECT_EQ(printable("a\nb\x1b[31m\t"), "a\\x0ab\\x1b[31m\\x09");
    EXPECT_EQ(printable(std::string("\0", 1)), "\\x00");
    EXPECT_EQ(printable("\x7f\xc2\x85"), "\\x7f\\xc2\\x85");  // DEL, NEL
    EXPECT_EQ(printable("\xe2\x80\xae"), "\\xe2\\x80\\xae");  // right-to-left override
    EXPECT_EQ(printable("\xff\xc0\xaf"), "\\xff\\xc0\\xaf");  // never in UTF-8; overlong
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // surrogate
    EXPECT_EQ(printable("\xe6\x97"), "\\xe6\\x97");           // cut short
}

TEST(Printable, LongTextsKeepTheirEnds) {
    const std::string text = printable(std::string(5000, 'a') + "end", 20);
    EXPECT_EQ(text, "aaaaaaaaaaaa...aaend");
}

RC_GTEST_PROP(Printable, AnyBytesBecomeShortVisibleText, (const std::string& bytes)) {
    const auto limit = *rc::gen::inRange<std::size_t>(8, 300);
    const std::string text = printable(bytes, limit);
    RC_ASSERT(has_only_visible_characters(text));
    RC_ASSERT(characters_of(text) <= limit);
}

RC_GTEST_PROP(Printable, MessagesQuoteFilesBriefly, (const std::string& name)) {
    std::string whole = name;
    while (!name.empty() && whole.size() < 5000) {
        whole += name;
    }
    const FileError error{"a.json", "/bodies/" + whole, "expected a name, found \"" + whole + "\""};
    const std::string message = error.message();
    RC_ASSERT(has_only_visible_characters(message));
    RC_ASSERT(characters_of(message) <= std::string("a.json: : expected a name").size() + 200);
}

}  // namespace
}  // namespace handhold::io_printable_test
