#pragma once

#include <memory>
#include <string>

#include "game/mesh/image.hpp"

namespace handhold {

struct VideoSettings {
    int width_px = 0;
    int height_px = 0;
    double frames_per_s = 30.0;
    std::string program = "ffmpeg";  // searched on PATH
};

// Writes an .mp4 with ffmpeg, which runs as a child process and receives raw pictures: H.264, or
// MPEG-4 part 2 if libx264 is missing. Videos are optional: a failure is reported as text and never
// stops a session.
class VideoWriter {
  public:
    // Null, with the reason in `why_not`, if the program is missing or cannot be started. No shell
    // is involved, so `path` may contain any character.
    static std::unique_ptr<VideoWriter> open(const std::string& path, const VideoSettings& settings,
                                             std::string& why_not);
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    // False if the encoder has ended or the picture has another size; later pictures are dropped.
    bool add(const Image& image);
    // Waits for the encoder and renames the file to its final name. On failure returns false and
    // the reason, and leaves no file. If finish() is not called, the destructor discards the video.
    bool finish(std::string& why_not);

  private:
    VideoWriter() = default;
    bool wait_for_encoder();

    std::string path_;
    std::string temporary_;
    VideoSettings settings_;
    int socket_ = -1;   // standard input of the encoder
    int process_ = -1;  // -1: none running
    bool failed_ = false;
};

}  // namespace handhold
