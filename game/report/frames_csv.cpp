#include "game/report/frames_csv.hpp"

#include <vector>

#include "engine/core/check.hpp"
#include "engine/core/text_file.hpp"
#include "game/report/text.hpp"

namespace handhold {
namespace {

constexpr char k_frames_header[] =
    "frame,t,player,origin_x,origin_y,origin_z,head_x,head_y,head_z,"
    "l_target_x,l_target_y,l_target_z,l_shown_x,l_shown_y,l_shown_z,l_grip,l_body,l_grab_error_mm,"
    "r_target_x,r_target_y,r_target_z,r_shown_x,r_shown_y,r_shown_z,r_grip,r_body,r_grab_error_mm,"
    "push_back_mm,residual_mm,contacts,"
    "velocity_x,velocity_y,velocity_z,islands,islands_pushed,contact_rounds,newton_iterations\n";
constexpr char k_bodies_header[] = "frame,t,body,mass_kg,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n";

// Slightly more than the average, so that most runs need one allocation.
constexpr std::size_t k_bytes_per_player_row = 560;
constexpr std::size_t k_bytes_per_body_row = 300;

// Writes the cells of a line, separated by commas.
class RowWriter {
  public:
    explicit RowWriter(std::string& text) : text_(text) {}

    void begin(const FrameLog& frame) {
        text_ += std::to_string(frame.frame);
        add(frame.t_s);
    }
    void end() { text_ += '\n'; }

    void add(double value) {
        text_ += ',';
        append_number(text_, value);
    }
    void add(const hh::Vec3& v) {
        for (const double value : {v.x, v.y, v.z}) {
            add(value);
        }
    }
    void add(const hh::Quat& q) {
        for (const double value : {q.x, q.y, q.z, q.w}) {
            add(value);
        }
    }
    void add_count(std::uint64_t value) { text_ += ',' + std::to_string(value); }
    void add_text(const std::string& quoted) { (text_ += ',') += quoted; }

  private:
    std::string& text_;
};

std::vector<std::string> quote_all(const std::vector<std::string>& names) {
    std::vector<std::string> quoted;
    quoted.reserve(names.size());
    for (const std::string& name : names) {
        quoted.push_back(quote_csv(name));
    }
    return quoted;
}

void write_hand(RowWriter& row, const HandLog& hand, const std::vector<std::string>& bodies) {
    const std::string none;
    const bool has_body = hand.body >= 0;
    const std::size_t body = has_body ? static_cast<std::size_t>(hand.body) : 0;
    HH_CHECK(!has_body || body < bodies.size(), "no body of this index", hand.body);
    row.add(hand.target_ws);
    row.add(hand.shown_ws);
    row.add_count(static_cast<std::uint64_t>(hand.grip));
    row.add_text(has_body ? bodies[body] : none);
    row.add(hand.error_m * k_mm_in_m);
}

void write_player(RowWriter& row, const FrameLog& frame, const PlayerLog& player,
                  const std::vector<std::string>& bodies) {
    const RunStats& stats = frame.stats;
    row.begin(frame);
    row.add_count(player.player);
    row.add(player.origin_ws);
    row.add(player.head_ws);
    for (const HandLog& hand : player.hands) {
        write_hand(row, hand, bodies);
    }
    row.add(player.push_back_m * k_mm_in_m);
    row.add(stats.residual_m * k_mm_in_m);
    row.add_count(stats.contacts);
    row.add(player.velocity_mps);
    for (const std::uint64_t count :
         {stats.islands, stats.islands_pushed, stats.contact_rounds, stats.newton_iterations}) {
        row.add_count(count);
    }
    row.end();
}

}  // namespace

std::string format_frames_csv(const RunLog& log) {
    std::size_t rows = 1;
    for (const FrameLog& frame : log.frames) {
        rows += frame.players.size();
    }
    std::string text = k_frames_header;
    text.reserve(rows * k_bytes_per_player_row);
    const std::vector<std::string> bodies = quote_all(log.body_names);
    RowWriter row(text);
    for (const FrameLog& frame : log.frames) {
        for (const PlayerLog& player : frame.players) {
            HH_CHECK(player.player < log.player_names.size(), "no player of this index",
                     player.player);
            write_player(row, frame, player, bodies);
        }
    }
    return text;
}

std::string format_bodies_csv(const RunLog& log) {
    HH_CHECK(log.body_mass_kg.size() == log.body_names.size(), "a mass for each body",
             log.body_mass_kg.size());
    std::size_t rows = 1;
    for (const FrameLog& frame : log.frames) {
        rows += frame.bodies.size();
    }
    std::string text = k_bodies_header;
    text.reserve(rows * k_bytes_per_body_row);
    const std::vector<std::string> bodies = quote_all(log.body_names);
    RowWriter row(text);
    for (const FrameLog& frame : log.frames) {
        for (const BodyLog& body : frame.bodies) {
            HH_CHECK(body.body < bodies.size(), "no body of this index", body.body);
            row.begin(frame);
            row.add_text(bodies[body.body]);
            row.add(log.body_mass_kg[body.body]);
            row.add(body.pose_ws.position);
            row.add(body.pose_ws.rotation);
            row.add(body.velocity_mps);
            row.add(body.spin_radps);
            row.end();
        }
    }
    return text;
}

std::optional<FileError> write_frames_csv(const std::filesystem::path& path, const RunLog& log) {
    return write_file_atomically(path, format_frames_csv(log));
}

std::optional<FileError> write_bodies_csv(const std::filesystem::path& path, const RunLog& log) {
    return write_file_atomically(path, format_bodies_csv(log));
}

}  // namespace handhold
