#include "game/report/report_html.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "components/stats.hpp"
#include "engine/core/text_file.hpp"
#include "game/mesh/image.hpp"
#include "game/report/fallback_meanings.hpp"
#include "game/report/report_tables.hpp"
#include "tests/game/report/report_log.hpp"

namespace handhold::report_html_test {
namespace {

// The first fault in the markup: a tag that closes another one, or is never closed; a stray < or &;
// an attribute without quotes. Empty if there is none. Style is skipped, because it is not markup.
std::string find_fault(const std::string& html) {
    const std::set<std::string> void_elements = {"meta", "img"};
    std::vector<std::string> open;
    std::size_t i = 0;
    while ((i = html.find_first_of("<&", i)) != std::string::npos) {
        const std::string around = html.substr(i, 40);
        if (html[i] == '&') {
            const std::size_t end = html.find(';', i);
            if (end == std::string::npos || end - i > 7) {
                return "bare & at " + around;
            }
            i = end;
            continue;
        }
        const std::size_t end = html.find('>', i);
        if (end == std::string::npos) {
            return "tag without end at " + around;
        }
        const std::string tag = html.substr(i + 1, end - i - 1);
        i = end;
        if (tag.empty() || tag == "!DOCTYPE html") {
            continue;
        }
        if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) {
            return "odd quotes at " + around;
        }
        const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
        if (name[0] == '/') {
            if (open.empty() || "/" + open.back() != name) {
                return "closes another element at " + around;
            }
            open.pop_back();
        } else if (tag.back() != '/' && !void_elements.contains(name)) {
            open.push_back(name);
            if (name == "style") {
                i = html.find("</style>", i) - 1;
            }
        }
    }
    return open.empty() ? "" : "never closed: " + open.back();
}

ReportMedia make_media() {
    ReportMedia media;
    media.pictures = {{"first <frame>", {'f', 'o', 'o', 'b', 'a'}}, {"last", {0xff, 0xee}}};
    media.video = "run.mp4";
    return media;
}

TEST(ReportHtml, CheckerFindsPlantedFaults) {
    EXPECT_EQ(find_fault("<p>a &amp; b<img alt=\"x\"><b>c</b></p>"), "");
    EXPECT_NE(find_fault("<p><b></p></b>"), "");
    EXPECT_NE(find_fault("<p>"), "");
    EXPECT_NE(find_fault("<p>a & b, and so on and on</p>"), "");
    EXPECT_NE(find_fault("<p class=\"x></p>"), "");
}

TEST(ReportHtml, IsWellFormedWhateverTheNames) {
    RunLog log = make_gripping_run();
    log.scene = "</title><script>alert(1)</script>";
    log.input = "\"quoted\" & 'so on'";
    log.player_names[1] = "<ben>";
    EXPECT_EQ(find_fault(format_report_html(log, make_media())), "");
    EXPECT_EQ(find_fault(format_report_html(RunLog())), "");
}

TEST(ReportHtml, NeedsNoNetworkAndNoScripts) {
    ReportMedia media = make_media();
    media.pictures[1].png = {1, 2, 3};  // base64 may hold "//" by itself
    const std::string html = format_report_html(make_gripping_run(), media);
    for (const char* const outside :
         {"http:", "https:", "//", "url(", "@import", "<script", "<link", "<iframe"}) {
        EXPECT_EQ(html.find(outside), std::string::npos) << outside;
    }
}

TEST(ReportHtml, HeaderTellsTheRun) {
    const std::string html = format_report_html(make_small_run());
    for (const char* const text :
         {"<h1>shaft &lt;7&gt;</h1>", "climb &amp; drift.csv", "auto: 1 2 3, yaw 90",
          "0x00abcdef01234567", "8 frames/s", "4 × real time", "17 m"}) {
        EXPECT_NE(html.find(text), std::string::npos) << text;
    }
}

TEST(ReportHtml, HoldsItsPicturesInTheirOrder) {
    const std::string html = format_report_html(make_small_run(), make_media());
    const std::size_t first = html.find("src=\"data:image/png;base64,Zm9vYmE=\"");
    const std::size_t last = html.find("src=\"data:image/png;base64,/+4=\"");
    ASSERT_NE(first, std::string::npos);
    ASSERT_NE(last, std::string::npos);
    EXPECT_LT(first, last);
    EXPECT_NE(html.find("<figcaption>first &lt;frame&gt;</figcaption>"), std::string::npos);
}

TEST(ReportHtml, VideoIsLinkedBesideThePage) {
    EXPECT_NE(format_report_html(make_small_run(), make_media()).find("<video controls"),
              std::string::npos);
    EXPECT_NE(format_report_html(make_small_run(), make_media()).find("src=\"run.mp4\""),
              std::string::npos);
    EXPECT_EQ(format_report_html(make_small_run()).find("<video"), std::string::npos);
}

TEST(ReportHtml, VideosNameIsNeverTakenForASchemeOrAQuery) {
    ReportMedia media;
    media.video = "a:b?c \"d\".mp4";
    EXPECT_NE(format_report_html(make_small_run(), media).find("src=\"a%3Ab%3Fc%20%22d%22.mp4\""),
              std::string::npos);
}

TEST(ReportHtml, ShowsEveryPlotOnce) {
    const std::string html = format_report_html(make_gripping_run());
    for (const char* const title :
         {"Head from above", "Head from the side", "Gripping hand against its anchor",
          "Push-back of the player", "Contact overlap left at the end of the frame",
          "Time of the frame and of its costliest stages"}) {
        const std::string label = std::string("aria-label=\"") + title + '"';
        const std::size_t first = html.find(label);
        ASSERT_NE(first, std::string::npos) << title;
        EXPECT_EQ(html.find(label, first + 1), std::string::npos) << title;
    }
    EXPECT_EQ(html.find("no data"), std::string::npos);
}

TEST(ReportHtml, EveryFallbackHasAMeaningOfItsOwn) {
    std::set<std::string> meanings;
    for (std::size_t i = 0; i < static_cast<std::size_t>(Fallback::count); ++i) {
        const std::string meaning = meaning_of(static_cast<Fallback>(i));
        EXPECT_FALSE(meaning.empty()) << name_of(static_cast<Fallback>(i));
        EXPECT_TRUE(meanings.insert(meaning).second) << meaning;
    }
}

TEST(ReportHtml, FallbacksThatNeverHappenedAreGrey) {
    RunLog log = make_small_run();
    ++log.frames[0].stats.fallbacks[static_cast<std::size_t>(Fallback::grip_stretched)];
    ++log.frames[2].stats.fallbacks[static_cast<std::size_t>(Fallback::grip_stretched)];
    const std::string html = format_report_html(log);
    EXPECT_NE(html.find("<tr><td>grip_stretched</td>"), std::string::npos);
    EXPECT_NE(html.find("<tr class=\"never\"><td>grip_body_gone</td>"), std::string::npos);
}

TEST(ReportHtml, FileHoldsThePage) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / "handhold_report_test.html";
    ASSERT_FALSE(write_report_html(path, make_small_run()));
    const Result<std::string> text = read_file(path);
    ASSERT_TRUE(text.ok());
    EXPECT_EQ(text.value(), format_report_html(make_small_run()));
    std::filesystem::remove(path);
    EXPECT_TRUE(write_report_html("/nowhere/report.html", make_small_run()).has_value());
}

TEST(ReportHtml, Base64AgreesWithTheVectorsOfRfc4648) {
    const std::vector<std::pair<std::string, std::string>> vectors = {{"", ""},
                                                                      {"f", "Zg=="},
                                                                      {"fo", "Zm8="},
                                                                      {"foo", "Zm9v"},
                                                                      {"foob", "Zm9vYg=="},
                                                                      {"fooba", "Zm9vYmE="},
                                                                      {"foobar", "Zm9vYmFy"}};
    for (const auto& [plain, encoded] : vectors) {
        EXPECT_EQ(encode_base64(std::vector<std::uint8_t>(plain.begin(), plain.end())), encoded);
    }
}

}  // namespace
}  // namespace handhold::report_html_test
