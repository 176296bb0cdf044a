// Tokens that admit players to a match.
#include "game/net/token.hpp"

#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "game/net/hmac.hpp"
#include "game/net/transport.hpp"
#include "tests/places.hpp"

namespace handhold::token_test {
namespace {

TokenKey key_of(char c) { return {std::vector<std::byte>(32, static_cast<std::byte>(c))}; }

// RFC 4231, test case 2.
TEST(Tokens, HmacIsThatOfTheStandard) {
    if (!has_network()) {
        GTEST_SKIP() << "built without a network";
    }
    const std::string key = "Jefe";
    const Sha256 sum = hmac_sha256(std::as_bytes(std::span(key)), "what do ya want for nothing?");
    EXPECT_EQ(sum[0], std::byte{0x5b});
    EXPECT_EQ(sum[1], std::byte{0xdc});
    EXPECT_EQ(sum[30], std::byte{0x38});
    EXPECT_EQ(sum[31], std::byte{0x43});
}

TEST(Tokens, AdmitUntilTheyExpire) {
    if (!has_network()) {
        GTEST_SKIP() << "built without a network";
    }
    const std::string token = issue_token(key_of('k'), "ann", 1000);
    EXPECT_EQ(check_token(key_of('k'), token, 999).state, TokenState::good);
    EXPECT_EQ(check_token(key_of('k'), token, 999).name, "ann");
    EXPECT_EQ(check_token(key_of('k'), token, 1000).state, TokenState::expired);
    EXPECT_EQ(check_token(key_of('x'), token, 999).state, TokenState::bad);
    EXPECT_EQ(check_token(key_of('x'), token, 1000).state, TokenState::bad);
}

TEST(Tokens, AnyChangeMakesThemBad) {
    if (!has_network()) {
        GTEST_SKIP() << "built without a network";
    }
    const std::string token = issue_token(key_of('k'), "ann", 1000);
    for (std::size_t at = 0; at < token.size(); ++at) {
        for (const char other : {'0', '9', 'a', 'b', '.', '\0'}) {
            std::string changed = token;
            if (changed[at] != other) {
                changed[at] = other;
                EXPECT_EQ(check_token(key_of('k'), changed, 1).state, TokenState::bad) << changed;
            }
        }
        EXPECT_EQ(check_token(key_of('k'), token.substr(0, at), 1).state, TokenState::bad);
    }
    EXPECT_EQ(check_token(key_of('k'), token + "0", 1).state, TokenState::bad);
}

RC_GTEST_PROP(Tokens, OtherTextsAreBad, (const std::string& text)) {
    if (has_network()) {
        RC_ASSERT(check_token(key_of('k'), text, 1).state == TokenState::bad);
        RC_ASSERT(check_token(key_of('k'), "hh1." + text, 1).state == TokenState::bad);
    }
}

TEST(Tokens, NamesThatWouldChangeTheTokenAreNone) {
    EXPECT_TRUE(is_token_name("Ann_1-b"));
    for (const char* const name : {"", "a.b", "a b", "a\n", "123456789012345678901234567890123"}) {
        EXPECT_FALSE(is_token_name(name)) << name;
    }
}

}  // namespace
}  // namespace handhold::token_test
