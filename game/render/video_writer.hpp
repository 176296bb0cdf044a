#pragma once

#include <memory>
#include <string>

#include "game/render/image.hpp"

namespace handhold {

struct VideoSettings {
    int width_px = 0;
    int height_px = 0;
    double frames_per_s = 30.0;
    std::string program = "ffmpeg";  // looked for on PATH
};

// An .mp4 by way of ffmpeg, which runs beside us and is fed raw pictures: H.264, or MPEG-4 part 2
// where libx264 is missing. A video is a nicety: every failure is a sentence, none stops a session.
class VideoWriter {
  public:
    // Nothing, and the reason, where the program is missing or cannot be started. The program is
    // started without a shell; `path` may hold any character.
    static std::unique_ptr<VideoWriter> open(const std::string& path, const VideoSettings& settings,
                                             std::string& why_not);
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    // False once the encoder has gone, or for a picture of another size; what follows is dropped.
    bool add(const Image& image);
    // Waits for the encoder and gives the file its name. False, the reason, and no file where
    // something failed. Without it, the destructor abandons the video.
    bool finish(std::string& why_not);

  private:
    VideoWriter() = default;
    bool wait_for_encoder();

    std::string path_;
    std::string temporary_;
    VideoSettings settings_;
    int socket_ = -1;   // the encoder's standard input
    int process_ = -1;  // -1: none running
    bool failed_ = false;
};

}  // namespace handhold
