#include "game/net/match_recording.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace handhold {
namespace {

constexpr std::string_view k_recording_magic = "HHMR";
constexpr std::size_t k_recording_version = 1;
constexpr std::size_t k_file_header = 8;   // magic, version
constexpr std::size_t k_part_header = 13;  // kind, size, checksum
constexpr std::uint64_t k_ticks_a_part = 90;

void put_number(std::uint64_t value, std::size_t size, std::vector<std::byte>& bytes) {
    for (std::size_t i = 0; i < size; ++i) {
        bytes.push_back(static_cast<std::byte>((value >> (8 * i)) & 0xffU));
    }
}
std::uint64_t number_at(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
        value |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
    }
    return value;
}

// FNV-1a, 64 bits, of kind, size and content.
std::uint64_t part_checksum(std::span<const std::byte> header, std::span<const std::byte> bytes) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const auto& span : {header, bytes}) {
        for (const std::byte byte : span) {
            hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3ULL;
        }
    }
    return hash;
}

FileError recording_error(const std::string& file, std::size_t at, const std::string& expected) {
    return {file, "byte " + std::to_string(at), "expected " + expected};
}

// Reads the part at `at`, and moves on behind it.
Result<RecordedPart> read_part(std::span<const std::byte> bytes, std::size_t& at,
                               const std::string& file) {
    const auto cut = [&] {
        return recording_error(file, at, "the rest of the recording: it was cut off");
    };
    if (bytes.size() - at < k_part_header) {
        return cut();
    }
    RecordedPart part;
    part.place = at;
    const auto kind = number_at(bytes, at, 1);
    const auto size = static_cast<std::size_t>(number_at(bytes, at + 1, 4));
    if (kind < 1 || kind > static_cast<std::uint64_t>(RecordedKind::end)) {
        return recording_error(file, at, "a part of a recording");
    }
    if (size > bytes.size() - at - k_part_header) {
        return cut();
    }
    part.kind = static_cast<RecordedKind>(kind);
    part.bytes = bytes.subspan(at + k_part_header, size);
    if (part_checksum(bytes.subspan(at, 5), part.bytes) != number_at(bytes, at + 5, 8)) {
        return recording_error(file, at, "a part with its checksum: the file is damaged");
    }
    at += k_part_header + size;
    return part;
}

}  // namespace

Result<MatchRecording> parse_match_recording(std::vector<std::byte> bytes,
                                             const std::string& file) {
    MatchRecording out;
    out.file = file;
    out.bytes = std::move(bytes);
    const std::span<const std::byte> all = out.bytes;
    const auto magic = std::as_bytes(std::span(k_recording_magic));
    if (all.size() < k_file_header || !std::ranges::equal(all.first(magic.size()), magic)) {
        return recording_error(file, 0, "a recording of a match");
    }
    if (number_at(all, 4, 4) != k_recording_version) {
        return recording_error(file, 4,
                               "version " + std::to_string(k_recording_version) +
                                   " of the format, found " + std::to_string(number_at(all, 4, 4)));
    }
    bool has_level = false;
    for (std::size_t at = k_file_header;;) {
        const Result<RecordedPart> read = read_part(all, at, file);
        if (!read) {
            return read.error();
        }
        const RecordedPart& part = read.value();
        if ((part.kind == RecordedKind::level) == has_level) {
            return recording_error(file, part.place, "the level once, before all else");
        }
        if (part.kind == RecordedKind::level) {
            std::optional<MatchOffer> level = read_offer(part.bytes);
            if (!level || level->version != k_net_version) {
                return recording_error(file, part.place, "a level of this version");
            }
            out.level = std::move(*level);
            has_level = true;
        } else if (part.kind == RecordedKind::end) {
            if (part.bytes.size() != 16 || at != all.size()) {
                return recording_error(file, part.place, "the end of the recording");
            }
            out.last_tick = number_at(part.bytes, 0, 8);
            out.last_hash = number_at(part.bytes, 8, 8);
            return out;
        } else {
            out.parts.push_back(part);
        }
    }
}

Result<MatchRecording> load_match_recording(const std::filesystem::path& path) {
    const Result<std::string> text = read_file(path);
    if (!text) {
        return text.error();
    }
    const auto bytes = std::as_bytes(std::span(text.value()));
    return parse_match_recording({bytes.begin(), bytes.end()}, path.string());
}

MatchRecorder::MatchRecorder(std::filesystem::path path, std::filesystem::path part,
                             std::FILE* file)
    : path_(std::move(path)), part_(std::move(part)), file_(file) {}

Result<std::unique_ptr<MatchRecorder>> MatchRecorder::open(const std::filesystem::path& path,
                                                           const MatchOffer& level) {
    const Result<std::filesystem::path> target = replaceable_file(path);
    if (!target) {
        return target.error();
    }
    std::filesystem::path part = target.value();
    part += ".part";
    std::FILE* const file = std::fopen(part.string().c_str(), "wb");
    if (file == nullptr) {
        return FileError{path.string(), "",
                         "expected a writable place in an existing folder: " +
                             std::generic_category().message(errno)};
    }
    std::unique_ptr<MatchRecorder> recorder(new MatchRecorder(target.value(), part, file));
    std::vector<std::byte> header;
    const auto magic = std::as_bytes(std::span(k_recording_magic));
    header.assign(magic.begin(), magic.end());
    put_number(k_recording_version, 4, header);
    if (std::fwrite(header.data(), 1, header.size(), file) < header.size()) {
        recorder->fail(std::generic_category().message(errno));
    }
    recorder->bytes_ = header.size();
    std::vector<std::byte> message;
    write_message(level, message);
    recorder->add(RecordedKind::level, message);
    if (recorder->error_) {
        return *recorder->error_;
    }
    return recorder;
}

MatchRecorder::~MatchRecorder() {
    if (file_ == nullptr) {
        return;
    }
    std::fclose(file_);
    if (!has_begun_) {
        std::error_code ignored;
        std::filesystem::remove(part_, ignored);
    }
}

void MatchRecorder::fail(const std::string& reason) {
    if (!error_) {
        error_ = FileError{path_.string(), "", "expected space for the recording: " + reason};
    }
}

// Each part is given to the system at once, so that a process that dies leaves all of them.
void MatchRecorder::add(RecordedKind kind, std::span<const std::byte> bytes) {
    if (error_) {
        return;
    }
    std::vector<std::byte> header = {static_cast<std::byte>(kind)};
    put_number(bytes.size(), 4, header);
    put_number(part_checksum(header, bytes), 8, header);
    if (std::fwrite(header.data(), 1, header.size(), file_) < header.size() ||
        std::fwrite(bytes.data(), 1, bytes.size(), file_) < bytes.size() ||
        std::fflush(file_) != 0) {
        fail(std::generic_category().message(errno));
    }
    bytes_ += header.size() + bytes.size();
}

void MatchRecorder::begin(std::uint64_t tick, std::span<const std::byte> state) {
    if (!state.empty()) {
        add(RecordedKind::state, state);
    }
    until_ = tick;
    has_begun_ = true;
    is_following_ = true;
}

void MatchRecorder::follow(const hh::Match& match, bool all) {
    if (!is_following_) {
        return;
    }
    while (!error_ && match.stats().confirmed >= until_ + (all ? 1 : k_ticks_a_part)) {
        const std::uint64_t before = until_;
        if (!match.confirmed_inputs(until_, packet_)) {
            fail(hh_last_error());
        } else if (until_ == before) {
            return;
        } else {
            add(RecordedKind::inputs, packet_);
        }
    }
}

void MatchRecorder::pause(const hh::Match& match) {
    if (match.is_valid()) {
        follow(match, true);
    }
    is_following_ = false;
}

std::optional<FileError> MatchRecorder::finish(const hh::Match& match) {
    if (match.is_valid()) {
        follow(match, true);
    }
    std::vector<std::byte> end;
    put_number(until_, 8, end);
    const hh::Maybe<std::uint64_t> hash = match.hash(until_);
    put_number(hash ? *hash : 0, 8, end);
    add(RecordedKind::end, end);
    if (std::fclose(std::exchange(file_, nullptr)) != 0) {
        fail(std::generic_category().message(errno));
    }
    if (error_) {
        return error_;
    }
    std::error_code failure;
    if (!has_begun_) {
        std::filesystem::remove(part_, failure);
        return FileError{path_.string(), "", "nothing was recorded"};
    }
    std::filesystem::rename(part_, path_, failure);
    if (failure) {
        fail(failure.message());
    }
    return error_;
}

}  // namespace handhold
