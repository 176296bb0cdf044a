#include "game/render/video_writer.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/core/text_file.hpp"

namespace handhold {
namespace {

// File descriptors for standard input and output of a child process; -1: /dev/null.
struct ChildStreams {
    int input = -1;
    int output = -1;
};

// Starts a program found on PATH and discards its standard error. Returns the process id, or -1 and
// the reason.
int start_program(const std::vector<std::string>& arguments, const ChildStreams& streams,
                  std::string& why_not) {
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments) {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const auto connect = [&actions](int from, int to, int mode) {
        if (from >= 0) {
            posix_spawn_file_actions_adddup2(&actions, from, to);
        } else {
            posix_spawn_file_actions_addopen(&actions, to, "/dev/null", mode, 0);
        }
    };
    connect(streams.input, STDIN_FILENO, O_RDONLY);
    connect(streams.output, STDOUT_FILENO, O_WRONLY);
    connect(-1, STDERR_FILENO, O_WRONLY);
    pid_t process = -1;
    // The encoder gets its own process group. Ctrl+C in the terminal then reaches only the game,
    // which ends the encoder properly.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    const int error = posix_spawnp(&process, argv[0], &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        why_not = arguments[0] + " cannot be started: " + std::system_category().message(error);
        return -1;
    }
    return process;
}

// True if the process exited by itself with status 0.
bool wait_for(int process) {
    int status = 0;
    while (waitpid(process, &status, 0) < 0) {
        if (errno != EINTR) {
            return false;
        }
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// Everything that a program prints. Empty, with the reason, if the program cannot be started or
// fails.
std::string output_of(const std::vector<std::string>& arguments, std::string& why_not) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
        why_not = std::string("no pipe: ") + std::system_category().message(errno);
        return {};
    }
    const int process = start_program(arguments, {.output = ends[1]}, why_not);
    close(ends[1]);
    std::string text;
    std::array<char, 4096> buffer{};
    while (process >= 0) {
        const ssize_t count = ::read(ends[0], buffer.data(), buffer.size());
        if (count > 0) {
            text.append(buffer.data(), static_cast<std::size_t>(count));
        } else if (count == 0 || errno != EINTR) {
            break;
        }
    }
    close(ends[0]);
    if (process >= 0 && !wait_for(process)) {
        why_not = arguments[0] + " failed";
        return {};
    }
    return text;
}

std::vector<std::string> encoder_arguments(const VideoSettings& settings, bool has_h264,
                                           const std::string& path) {
    const std::string size =
        std::to_string(settings.width_px) + "x" + std::to_string(settings.height_px);
    std::vector<std::string> arguments = {
        settings.program, "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgba",
        "-video_size", size, "-framerate", std::to_string(settings.frames_per_s), "-i", "pipe:0",
        // Every video player supports yuv420p. This format halves the colours' resolution, so width
        // and height must be even.
        "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", "-movflags", "+faststart"};
    const std::vector<std::string> codec =
        has_h264 ? std::vector<std::string>{"-c:v", "libx264", "-preset", "fast", "-crf", "20"}
                 : std::vector<std::string>{"-c:v", "mpeg4", "-q:v", "4"};
    arguments.insert(arguments.end(), codec.begin(), codec.end());
    // "file:" keeps ffmpeg from interpreting a colon or a leading dash in the name.
    arguments.insert(arguments.end(), {"-f", "mp4", "file:" + path});
    return arguments;
}

}  // namespace

std::unique_ptr<VideoWriter> VideoWriter::open(const std::string& path,
                                               const VideoSettings& settings,
                                               std::string& why_not) {
    if (settings.width_px <= 0 || settings.height_px <= 0 || !(settings.frames_per_s > 0.0)) {
        why_not = "a video needs a size and a frame rate above 0";
        return nullptr;
    }
    const Result<std::filesystem::path> target = replaceable_file(path);
    if (!target) {
        why_not = target.error().message();
        return nullptr;
    }
    const std::string encoders =
        output_of({settings.program, "-hide_banner", "-encoders"}, why_not);
    if (encoders.empty()) {
        return nullptr;
    }
    // A socket instead of a pipe: writing to an encoder that has ended then gives an error, not a
    // signal.
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        why_not = std::string("no socket: ") + std::system_category().message(errno);
        return nullptr;
    }
    const std::string temporary = target.value().string() + ".part";
    const bool has_h264 = encoders.find("libx264") != std::string::npos;
    const int process = start_program(encoder_arguments(settings, has_h264, temporary),
                                      {.input = ends[1]}, why_not);
    close(ends[1]);
    if (process < 0) {
        close(ends[0]);
        return nullptr;
    }
    std::unique_ptr<VideoWriter> writer(new VideoWriter);
    writer->path_ = target.value().string();
    writer->temporary_ = temporary;
    writer->settings_ = settings;
    writer->socket_ = ends[0];
    writer->process_ = process;
    return writer;
}

VideoWriter::~VideoWriter() {
    if (process_ >= 0) {
        wait_for_encoder();
        std::error_code ignored;
        std::filesystem::remove(temporary_, ignored);
    }
}

bool VideoWriter::add(const Image& image) {
    if (failed_ || image.width_px != settings_.width_px || image.height_px != settings_.height_px) {
        failed_ = true;
        return false;
    }
    std::size_t sent = 0;
    while (sent < image.rgba.size()) {
        const ssize_t count =
            send(socket_, image.rgba.data() + sent, image.rgba.size() - sent, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) {
            continue;
        }
        if (count <= 0) {
            failed_ = true;
            return false;
        }
        sent += static_cast<std::size_t>(count);
    }
    return true;
}

bool VideoWriter::wait_for_encoder() {
    close(socket_);  // signals end of file to the encoder
    socket_ = -1;
    const bool succeeded = wait_for(process_);
    process_ = -1;
    return succeeded;
}

bool VideoWriter::finish(std::string& why_not) {
    if (process_ < 0) {
        why_not = "the video is already finished";
        return false;
    }
    const bool encoded = wait_for_encoder() && !failed_;
    std::error_code error;
    if (!encoded) {
        std::filesystem::remove(temporary_, error);
        why_not = settings_.program + " did not write " + path_;
        return false;
    }
    std::filesystem::rename(temporary_, path_, error);
    if (error) {
        why_not = path_ + ": " + error.message();
        std::filesystem::remove(temporary_, error);
        return false;
    }
    return true;
}

}  // namespace handhold
