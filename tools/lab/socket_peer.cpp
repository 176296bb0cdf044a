#include "tools/lab/socket_peer.hpp"

#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>
#include <type_traits>
#include <utility>

#include "engine/core/profile.hpp"
#include "game/commands/match_entry.hpp"
#include "game/net/peer_hands.hpp"
#include "systems/host/host_columns.hpp"
#include "tools/lab/exit_status.hpp"
#include "tools/lab/socket_world.hpp"

namespace handhold::lab {
namespace {

constexpr double k_look_s = 0.002;
constexpr double k_join_within_s = 20.0;

// Counts the messages of another link.
class CountingLink final : public Link {
  public:
    CountingLink(std::unique_ptr<Link> link, PeerSecond& counts)
        : link_(std::move(link)), counts_(counts) {}

    void poll(double wait_s, LinkHandler& handler) override {
        Counter counter(handler, counts_);
        link_->poll(wait_s, counter);
    }
    void send(Delivery delivery, std::span<const std::byte> message) override {
        counts_.up_bytes += static_cast<double>(message.size());
        counts_.up_messages += 1.0;
        link_->send(delivery, message);
    }
    std::size_t queued_bytes() const override { return link_->queued_bytes(); }
    void close() override { link_->close(); }

  private:
    class Counter final : public LinkHandler {
      public:
        Counter(LinkHandler& handler, PeerSecond& counts) : handler_(handler), counts_(counts) {}
        void opened() override { handler_.opened(); }
        void received(std::span<const std::byte> message) override {
            counts_.down_bytes += static_cast<double>(message.size());
            counts_.down_messages += 1.0;
            handler_.received(message);
        }
        void closed(std::string_view why) override { handler_.closed(why); }

      private:
        LinkHandler& handler_;
        PeerSecond& counts_;
    };

    std::unique_ptr<Link> link_;
    PeerSecond& counts_;
};

template <typename T>
bool write_list(std::FILE* file, const std::vector<T>& list) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::uint64_t size = list.size();
    return std::fwrite(&size, sizeof(size), 1, file) == 1 &&
           std::fwrite(list.data(), sizeof(T), list.size(), file) == list.size();
}
template <typename T>
bool read_list(std::FILE* file, std::vector<T>& list) {
    std::uint64_t size = 0;
    constexpr std::uint64_t k_most = std::uint64_t{1} << 28U;
    if (std::fread(&size, sizeof(size), 1, file) != 1 || size > k_most) {
        return false;
    }
    list.resize(size);
    return std::fread(list.data(), sizeof(T), list.size(), file) == list.size();
}
using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
File open_file(const std::filesystem::path& path, const char* mode) {
    return {std::fopen(path.c_str(), mode), std::fclose};
}

std::optional<FileError> save(const PeerNotes& notes, const std::filesystem::path& path) {
    const File file = open_file(path, "wb");
    const bool is_written =
        file != nullptr && write_list(file.get(), std::vector{notes.end}) &&
        write_list(file.get(), notes.ticks) && write_list(file.get(), notes.others) &&
        write_list(file.get(), notes.hashes) && write_list(file.get(), notes.frames) &&
        write_list(file.get(), notes.seconds);
    return is_written ? std::nullopt
                      : std::optional(FileError{path.string(), "", "expected a writable file"});
}

// A player who climbs and writes down what happens.
class SocketPeer {
  public:
    SocketPeer(const SocketPeerTask& task, MatchScene& scene)
        : task_(task),
          scene_(scene),
          peer_(scene.scene.host, scene.players, make_peer_settings(scene, "")) {}

    std::optional<FileError> connect() {
        Result<std::unique_ptr<Link>> link = open_link(task_.url);
        if (!link) {
            return link.error();
        }
        const double begin_s = match_now_s();
        peer_.connect(std::make_unique<CountingLink>(std::move(link.value()), second_));
        while (peer_.stage() != PeerStage::playing) {
            peer_.poll(k_look_s, [](double, PeerInput&) {});
            if (peer_.stage() == PeerStage::ended || match_now_s() > begin_s + k_join_within_s) {
                return FileError{task_.url, "", "could not join: " + peer_.why()};
            }
        }
        notes_.end.join_s = match_now_s() - begin_s;
        notes_.end.slot = peer_.slot();
        second_ = {};
        return std::nullopt;
    }

    // Error: the connection was lost.
    std::optional<FileError> play() {
        const ClimberHands climber(scene_.scene, scene_.players[peer_.slot()], task_.seed);
        hands_ = climber;
        notes_.end.begin_s = match_now_s();
        bool froze = task_.freeze_s == 0.0;
        for (double at_s = 0.0; at_s < task_.seconds; at_s = since_begin_s()) {
            if (!froze && at_s >= task_.freeze_at_s) {
                froze = true;
                std::this_thread::sleep_for(std::chrono::duration<double>(task_.freeze_s));
            }
            frame();
            if (peer_.stage() == PeerStage::ended) {
                return FileError{task_.url, "", peer_.why()};
            }
        }
        finish();
        return std::nullopt;
    }

    const PeerNotes& notes() const { return notes_; }

  private:
    double since_begin_s() const { return match_now_s() - notes_.end.begin_s; }

    void frame() {
        const std::uint64_t again = peer_.match().stats().steps_again;
        const std::int64_t begin_ns = thread_cpu_now_ns();
        const std::uint32_t ticks = peer_.poll(0.0, [this](double end_s, PeerInput& input) {
            note_tick();
            hands_(end_s, input);
        });
        const double us = 1e-3 * static_cast<double>(thread_cpu_now_ns() - begin_ns);
        if (ticks == 0) {
            std::this_thread::sleep_for(std::chrono::duration<double>(k_look_s));
            return;
        }
        const double at_s = since_begin_s();
        notes_.frames.push_back({at_s, at_s - last_frame_s_, us, static_cast<double>(ticks),
                                 static_cast<double>(peer_.match().stats().steps_again - again)});
        last_frame_s_ = at_s;
        note_hashes();
        if (at_s < k_warm_s) {
            notes_.end.early_ticks = peer_.match().stats().ticks;
            notes_.end.early_filled = peer_.match().stats().filled;
        }
        while (static_cast<double>(notes_.seconds.size()) + 1.0 < at_s) {
            notes_.seconds.push_back(std::exchange(second_, {}));
        }
    }

    // The present tick, before the world can go back.
    void note_tick() {
        const std::uint64_t tick = scene_.scene.host.frame();
        if (!notes_.ticks.empty() && tick <= notes_.ticks.back().tick) {
            return;
        }
        notes_.ticks.push_back({tick, own_hands(scene_.scene, scene_.players[peer_.slot()])});
        add_all_hands(scene_, notes_.others);
    }
    void note_hashes() {
        const hh_match_stats stats = peer_.match().stats();
        for (std::uint64_t tick = hashed_until_ + 1; tick <= stats.confirmed; ++tick) {
            if (const auto hash = peer_.match().hash(tick)) {  // not if it is too old
                notes_.hashes.push_back({tick, *hash});
            }
        }
        hashed_until_ = stats.confirmed;
    }
    void finish() {
        const hh_match_stats stats = peer_.match().stats();
        notes_.end.ticks = stats.ticks;
        notes_.end.stalls = stats.waits;
        notes_.end.filled = stats.filled;
        notes_.end.rollbacks = stats.rollbacks;
        notes_.end.states = peer_.states();
        leave_match(peer_);
    }

    const SocketPeerTask& task_;
    MatchScene& scene_;
    PeerSecond second_;  // the present one
    MatchPeer peer_;
    PeerHands hands_;
    PeerNotes notes_;
    double last_frame_s_ = 0.0;
    std::uint64_t hashed_until_ = 0;
};

}  // namespace

Result<PeerNotes> load_peer_notes(const std::filesystem::path& path) {
    const File file = open_file(path, "rb");
    PeerNotes notes;
    std::vector<PeerEnd> end;
    const bool is_read =
        file != nullptr && read_list(file.get(), end) && end.size() == 1 &&
        read_list(file.get(), notes.ticks) && read_list(file.get(), notes.others) &&
        read_list(file.get(), notes.hashes) && read_list(file.get(), notes.frames) &&
        read_list(file.get(), notes.seconds);
    if (!is_read) {
        return FileError{path.string(), "", "expected what a player has written down"};
    }
    notes.end = end.front();
    return notes;
}

int run_socket_peer(const SocketPeerTask& task) {
    const Result<MatchOffer> offer = fetch_offer(task.url, k_join_within_s);
    if (!offer) {
        return refuse(offer.error());
    }
    Result<MatchScene> scene = load_entry_scene({task.url, task.scene, ""}, offer.value());
    if (!scene) {
        return refuse(scene.error());
    }
    SocketPeer peer(task, scene.value());
    if (const auto error = peer.connect()) {
        return refuse(*error);
    }
    if (const auto error = peer.play()) {
        return refuse(*error);
    }
    if (const auto error = save(peer.notes(), task.notes)) {
        return refuse(*error);
    }
    return 0;
}

}  // namespace handhold::lab
