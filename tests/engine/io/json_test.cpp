#include "engine/io/json.hpp"

#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace handhold::io_json_test {
namespace {

FileError error_of_parse(const std::string& text) {
    const Result<JsonDocument> document = JsonDocument::parse(text, "f.json");
    EXPECT_FALSE(document.ok()) << text;
    return document.ok() ? FileError() : document.error();
}

// The error message after reading a document with `read`; empty if there is none.
std::string message_of(const std::string& text, const std::function<void(const JsonValue&)>& read) {
    const Result<JsonDocument> document = JsonDocument::parse(text, "f.json");
    if (!document) {
        return document.error().message();
    }
    read(document.value().root());
    return document.value().failed() ? document.value().error().message() : "";
}

TEST(Json, ReadsEveryType) {
    const Result<JsonDocument> document = JsonDocument::parse(
        R"({"n": -1.5e3, "i": 7, "f": true, "t": "x", "v": [1, 2, 3], "q": [0, 0, 0, 1], "a": [4, 5]})",
        "f.json");
    ASSERT_TRUE(document.ok());
    const JsonValue root = document.value().root();
    EXPECT_EQ(root["n"].number(), -1500.0);
    EXPECT_EQ(root["i"].integer(0, 10), 7);
    EXPECT_TRUE(root["f"].flag());
    EXPECT_EQ(root["t"].text(), "x");
    EXPECT_EQ(root["v"].vector(), Vec3(1.0, 2.0, 3.0));
    EXPECT_EQ(root["q"].rotation().coeffs(), Quat::Identity().coeffs());
    ASSERT_EQ(root["a"].items().size(), 2U);
    EXPECT_EQ(root["a"].items()[1].number(), 5.0);
    EXPECT_EQ(root["absent"].number_or(9.0), 9.0);
    EXPECT_TRUE(root["absent"].optional_items().empty());
    EXPECT_FALSE(document.value().failed());
}

TEST(Json, ParseErrorNamesLineAndColumn) {
    // The misplaced ] is the third character of the second line.
    const FileError error = error_of_parse("{\"a\":\n  ]}");
    EXPECT_EQ(error.file, "f.json");
    EXPECT_EQ(error.place, "line 2, column 3");
    EXPECT_EQ(error.expected.rfind("expected JSON: ", 0), 0U);
}

TEST(Json, RefusesNumberThatNoDoubleHolds) {
    const FileError error = error_of_parse("{\"a\": 1,\n \"b\": 1e999}");
    EXPECT_EQ(error.place.rfind("line 2, ", 0), 0U) << error.message();
    EXPECT_NE(error.expected.find("1e999"), std::string::npos);
}

TEST(Json, RefusesDuplicateKeysAtTheirObject) {
    EXPECT_EQ(error_of_parse(R"({"a": [0, {"b": {"c": 1, "c": 2}}]})").message(),
              R"(f.json: /a/1/b: expected every key once, found "c" twice)");
    EXPECT_EQ(error_of_parse(R"({"a": 1, "a": 1})").place, "");
}

TEST(Json, EqualKeysOfDifferentObjectsAreNoDuplicates) {
    EXPECT_TRUE(JsonDocument::parse(R"({"a": {"a": {"a": 1}}, "b": {"a": 1}})", "f.json").ok());
}

TEST(Json, RefusesWhatIsNoJson) {
    for (const char* text :
         {"", "{", "{}x", "nan", "NaN", "[1,]", "{'a':1}", "\"\xFF\"", "[1 2]", "+1", "01"}) {
        error_of_parse(text);
    }
}

TEST(Json, AllowsSixtyFourLevelsAndNoMore) {
    EXPECT_TRUE(JsonDocument::parse(std::string(64, '[') + std::string(64, ']'), "f.json").ok());
    EXPECT_NE(
        error_of_parse(std::string(65, '[') + std::string(65, ']')).expected.find("64 levels"),
        std::string::npos);
}

TEST(Json, EveryTruncationIsAnError) {
    const std::string whole = R"({"a": [1.25, true, null, "x\n"], "b": {"c": -3e2}})";
    ASSERT_TRUE(JsonDocument::parse(whole, "f.json").ok());
    for (std::size_t length = 0; length < whole.size(); ++length) {
        EXPECT_EQ(error_of_parse(whole.substr(0, length)).place.rfind("line 1, column ", 0), 0U)
            << length;
    }
}

TEST(Json, ErrorNamesPointerExpectedAndFound) {
    EXPECT_EQ(message_of(R"({"bodies": [{"mass_kg": -2}]})",
                         [](const JsonValue& root) {
                             root["bodies"].items()[0]["mass_kg"].number(k_positive);
                         }),
              "f.json: /bodies/0/mass_kg: expected a number above 0, found -2");
    EXPECT_EQ(message_of("{}", [](const JsonValue& root) { root["name"].text(); }),
              "f.json: /name: expected a text that is not empty, found nothing");
    EXPECT_EQ(message_of(R"({"x": {}})", [](const JsonValue& root) { root["x"].flag(); }),
              "f.json: /x: expected true or false, found an object");
    EXPECT_EQ(message_of(R"({"x": [1, 2]})", [](const JsonValue& root) { root["x"].vector(); }),
              "f.json: /x: expected an array of 3 numbers, found an array of 2");
    EXPECT_EQ(
        message_of(R"({"x": [1, null, 2]})", [](const JsonValue& root) { root["x"].vector(); }),
        "f.json: /x/1: expected a number, found null");
}

TEST(Json, PointerEscapesSlashAndTilde) {
    EXPECT_EQ(
        message_of(R"({"a/b~c": "x"})", [](const JsonValue& root) { root["a/b~c"].number(); }),
        "f.json: /a~1b~0c: expected a number, found \"x\"");
}

TEST(Json, UnknownKeyIsAnErrorThatListsTheKnown) {
    EXPECT_EQ(message_of(R"({"colour": 1})",
                         [](const JsonValue& root) {
                             root.allow_only({"color", "name"});
                         }),
              R"(f.json: /colour: expected one of the keys color, name, found "colour")");
}

TEST(Json, FirstErrorWinsAndLaterReadsAreHarmless) {
    EXPECT_EQ(message_of(R"({"a": 1})",
                         [](const JsonValue& root) {
                             EXPECT_EQ(root["a"].text(), "");
                             EXPECT_EQ(root["a"]["b"]["c"].vector(), Vec3(Vec3::Zero()));
                             EXPECT_TRUE(root["a"].items().empty());
                         }),
              "f.json: /a: expected a text that is not empty, found 1");
}

TEST(Json, NumbersKeepTheirRange) {
    const auto read = [](double low, double high, bool above) {
        return [=](const JsonValue& root) { root.number({low, high, above}); };
    };
    EXPECT_EQ(message_of("0", read(0.0, 1.0, false)), "");
    EXPECT_EQ(message_of("1", read(0.0, 1.0, false)), "");
    EXPECT_EQ(message_of("0", read(0.0, 1.0, true)),
              "f.json: expected a number in (0, 1], found 0");
    EXPECT_EQ(message_of("1.5", read(0.0, 1.0, false)),
              "f.json: expected a number in [0, 1], found 1.5");
    EXPECT_NE(message_of("1e300", [](const JsonValue& root) { root.number(); }), "");
}

TEST(Json, IntegersAreWrittenWithoutFractionAndDoNotWrap) {
    for (const char* text : {"1.0", "1.5", "-1", "256", "18446744073709551615", "\"1\""}) {
        EXPECT_NE(message_of(text, [](const JsonValue& root) { root.integer(0, 255); }), "")
            << text;
    }
    EXPECT_EQ(
        message_of("255", [](const JsonValue& root) { EXPECT_EQ(root.integer(0, 255), 255); }), "");
}

TEST(Json, RotationsAreMadeUnitWithinOnePercent) {
    EXPECT_EQ(
        message_of("[0, 0.604, 0, 0.804]",
                   [](const JsonValue& root) { EXPECT_NEAR(root.rotation().norm(), 1.0, 1e-15); }),
        "");
    EXPECT_NE(message_of("[0, 0, 0, 1.02]", [](const JsonValue& root) { root.rotation(); }), "");
    EXPECT_NE(message_of("[0, 0, 0, 0]", [](const JsonValue& root) { root.rotation(); }), "");
}

TEST(Json, DumpsAPartForAnotherParser) {
    const Result<JsonDocument> document =
        JsonDocument::parse(R"({"a": {"b": [1, 2.5]}, "c": 1})", "f.json");
    ASSERT_TRUE(document.ok());
    EXPECT_EQ(document.value().root().dump_without({"c"}), R"({"a":{"b":[1,2.5]}})");
}

}  // namespace
}  // namespace handhold::io_json_test
