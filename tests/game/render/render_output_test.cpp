// Pictures and films as files. Oracles: the PNG specification's signature and header, RFC 4648's
// examples, ffprobe.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "game/mesh/image.hpp"
#include "game/render/video_writer.hpp"

namespace handhold::render_output_test {
namespace {

Image make_gradient(int width_px, int height_px) {
    Image image;
    image.width_px = width_px;
    image.height_px = height_px;
    for (int y = 0; y < height_px; ++y) {
        for (int x = 0; x < width_px; ++x) {
            for (const int value : {7 * x, 11 * y, x + y, 255}) {
                image.rgba.push_back(static_cast<std::uint8_t>(value & 255));
            }
        }
    }
    return image;
}

// A temporary folder, removed with the object.
struct Folder {
    std::filesystem::path path;
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "handhold_XXXXXX").string();
        path = mkdtemp(name.data());
    }
    ~Folder() { std::filesystem::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string file(const char* name) const { return (path / name).string(); }
};

TEST(Picture, PngRoundTripKeepsEveryByte) {
    const Image image = make_gradient(37, 21);
    const std::vector<std::uint8_t> png = encode_png(image);
    constexpr std::array<std::uint8_t, 8> k_signature = {0x89, 'P',  'N',  'G',
                                                         '\r', '\n', 0x1a, '\n'};
    ASSERT_GT(png.size(), 33U);
    EXPECT_TRUE(std::equal(k_signature.begin(), k_signature.end(), png.begin()));
    EXPECT_EQ(png[19], 37);  // last byte of the header's width
    EXPECT_EQ(png[23], 21);
    EXPECT_EQ(png[25], 6);  // colour type: RGB with alpha
    const std::optional<Image> back = decode_png(png);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->width_px, 37);
    EXPECT_EQ(back->rgba, image.rgba);
}

TEST(Picture, InvalidPngIsRefused) {
    const std::array<std::uint8_t, 5> junk = {1, 2, 3, 4, 5};
    EXPECT_FALSE(decode_png(junk));
    EXPECT_TRUE(encode_png(Image{}).empty());
}

TEST(Picture, PixelOutsideIsRefused) {
    const Image image = make_gradient(4, 3);
    EXPECT_EQ(image.pixel(3, 2)[0], 21);
    EXPECT_ANY_THROW(image.pixel(4, 0));
    EXPECT_ANY_THROW(image.pixel(0, -1));
}

TEST(Picture, SaveWritesAWholeFileOrNothing) {
    const Folder folder;
    const Image image = make_gradient(8, 8);
    EXPECT_FALSE(save_png(image, folder.file("a.png")));
    EXPECT_EQ(std::filesystem::file_size(folder.file("a.png")), encode_png(image).size());
    EXPECT_TRUE(save_png(image, folder.file("missing/a.png")));
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.png.part")));
}

TEST(Picture, Base64MatchesTheRfcsExamples) {
    const auto encode = [](std::string_view text) {
        return encode_base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    };
    EXPECT_EQ(encode(""), "");
    EXPECT_EQ(encode("f"), "Zg==");
    EXPECT_EQ(encode("fo"), "Zm8=");
    EXPECT_EQ(encode("foo"), "Zm9v");
    EXPECT_EQ(encode("foobar"), "Zm9vYmFy");
}

TEST(Film, ContainsEveryAddedFrame) {
    const Folder folder;
    const std::string path = folder.file("a film's $(name).mp4");
    std::string why_not;
    const auto writer = VideoWriter::open(path, {65, 33, 30.0}, why_not);
    if (writer == nullptr) {
        GTEST_SKIP() << "no film can be written here: " << why_not;
    }
    for (int i = 0; i < 12; ++i) {
        ASSERT_TRUE(writer->add(make_gradient(65, 33)));
    }
    ASSERT_TRUE(writer->finish(why_not)) << why_not;
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
    std::filesystem::rename(path, folder.file("film.mp4"));
    const std::string probe =
        "ffprobe -v error -count_frames -show_entries "
        "stream=nb_read_frames,width,height,pix_fmt -of csv=p=0 " +
        folder.file("film.mp4") + " > " + folder.file("probe.txt");
    if (std::system(probe.c_str()) != 0) {
        GTEST_SKIP() << "no ffprobe";
    }
    std::string line;
    std::getline(std::ifstream(folder.file("probe.txt")), line);
    EXPECT_EQ(line, "66,34,yuv420p,12");  // even sides, as yuv420p needs
}

TEST(Film, MissingProgramGivesAReason) {
    std::string why_not;
    const VideoSettings settings{64, 64, 30.0, "handhold-no-such-program"};
    EXPECT_EQ(VideoWriter::open("film.mp4", settings, why_not), nullptr);
    EXPECT_NE(why_not.find("handhold-no-such-program"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists("film.mp4.part"));
}

TEST(Film, DeadEncoderIsReportedAtTheEnd) {
    const Folder folder;
    std::string why_not;
    const auto writer =
        VideoWriter::open(folder.file("missing/film.mp4"), {640, 360, 30.0}, why_not);
    if (writer == nullptr) {
        GTEST_SKIP() << "no film can be written here: " << why_not;
    }
    for (int i = 0; i < 30; ++i) {
        writer->add(make_gradient(640, 360));  // must neither block nor kill the process
    }
    EXPECT_FALSE(writer->finish(why_not));
    EXPECT_NE(why_not.find("film.mp4"), std::string::npos);
}

TEST(Film, PictureOfAnotherSizeIsRefused) {
    const Folder folder;
    std::string why_not;
    const auto writer = VideoWriter::open(folder.file("film.mp4"), {64, 64, 30.0}, why_not);
    if (writer == nullptr) {
        GTEST_SKIP() << "no film can be written here: " << why_not;
    }
    EXPECT_FALSE(writer->add(make_gradient(32, 32)));
    EXPECT_FALSE(writer->finish(why_not));
    EXPECT_FALSE(std::filesystem::exists(folder.file("film.mp4")));
}

}  // namespace
}  // namespace handhold::render_output_test
