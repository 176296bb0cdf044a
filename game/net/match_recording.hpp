#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <handhold/match.hpp>

#include "game/files/file_tools.hpp"
#include "game/net/net_messages.hpp"

// A file of a whole match, which `handhold run --match` plays again: what is played, the state it
// began with, and the confirmed inputs of all slots. docs/reference/match_recording.md.
namespace handhold {

enum class RecordedKind : std::uint8_t {
    level = 1,   // a MatchOffer: the first part
    state = 2,   // a join state, with the rules' state: the match goes on from it
    inputs = 3,  // a packet of hh_match_confirmed_inputs
    end = 4,     // the last tick and its hash: the last part
};

struct RecordedPart {
    RecordedKind kind = RecordedKind::end;
    std::size_t place = 0;  // the offset of the part in the file
    std::span<const std::byte> bytes;
};

// A recording that is read. All of it has been checked for damage, not for sense.
struct MatchRecording {
    std::string file;
    MatchOffer level;
    std::vector<RecordedPart> parts;  // states and inputs
    std::uint64_t last_tick = 0;
    std::uint64_t last_hash = 0;
    std::vector<std::byte> bytes;  // the parts point into it
};
Result<MatchRecording> load_match_recording(const std::filesystem::path& path);
// `file`: its name in errors.
Result<MatchRecording> parse_match_recording(std::vector<std::byte> bytes, const std::string& file);

// Writes a match while it is played, to FILE.part, which becomes FILE at the end.
class MatchRecorder {
  public:
    // Error: the file cannot be written.
    static Result<std::unique_ptr<MatchRecorder>> open(const std::filesystem::path& path,
                                                       const MatchOffer& level);
    ~MatchRecorder();
    MatchRecorder(const MatchRecorder&) = delete;
    MatchRecorder& operator=(const MatchRecorder&) = delete;

    // The match begins, or goes on, with the state after `tick`. Empty: the scene's own.
    void begin(std::uint64_t tick, std::span<const std::byte> state);
    // Writes ticks that are confirmed, a second at a time; with `all` those that are left too. Call
    // at least once in three seconds, and with `all` before the match's state is replaced.
    void follow(const hh::Match& match, bool all = false);
    // Writes what is confirmed, and no tick of another match until `begin`.
    void pause(const hh::Match& match);
    // Writes the rest and the end; without a tick there is no file, and one that was there stays.
    // Returns the first error since open.
    [[nodiscard]] std::optional<FileError> finish(const hh::Match& match);
    // False once something could not be written; the recorder then does nothing any more.
    bool is_good() const { return !error_; }
    std::uint64_t bytes() const { return bytes_; }

  private:
    MatchRecorder(std::filesystem::path path, std::filesystem::path part, std::FILE* file);
    void add(RecordedKind kind, std::span<const std::byte> bytes);
    void fail(const std::string& reason);

    std::filesystem::path path_;
    std::filesystem::path part_;
    std::FILE* file_;
    std::optional<FileError> error_;
    std::uint64_t until_ = 0;  // ticks up to this one are written
    bool has_begun_ = false;
    bool is_following_ = false;
    std::uint64_t bytes_ = 0;
    std::vector<std::byte> packet_;  // reused
};

}  // namespace handhold
