// What a match server says over HTTP.
#include <array>
#include <cstdio>
#include <numeric>

#include "game/net/match_server.hpp"

namespace handhold {
namespace {

class Metrics {
  public:
    void add(std::string_view name, std::string_view kind, std::string_view help, double value) {
        begin(name, kind, help);
        line(name, "", value);
    }
    void begin(std::string_view name, std::string_view kind, std::string_view help) {
        text_ += "# HELP handhold_" + std::string(name) + " " + std::string(help) + "\n";
        text_ += "# TYPE handhold_" + std::string(name) + " " + std::string(kind) + "\n";
    }
    void line(std::string_view name, std::string_view labels, double value) {
        std::array<char, 64> number{};
        std::snprintf(number.data(), number.size(), " %.17g\n", value);
        text_ += "handhold_" + std::string(name) + std::string(labels) + number.data();
    }
    std::string take() { return std::move(text_); }

  private:
    std::string text_;
};

double as_number(std::uint64_t count) { return static_cast<double>(count); }

void add_traffic(const ListenerCounts& counts, Metrics& out) {
    out.add("connections_total", "counter", "Connections that were opened.",
            as_number(counts.opened));
    out.begin("bytes_total", "counter", "Bytes of messages, without headers.");
    out.line("bytes_total", "{way=\"in\"}", as_number(counts.received_bytes));
    out.line("bytes_total", "{way=\"out\"}", as_number(counts.sent_bytes));
    out.begin("messages_total", "counter", "Messages.");
    out.line("messages_total", "{way=\"in\"}", as_number(counts.received_messages));
    out.line("messages_total", "{way=\"out\"}", as_number(counts.sent_messages));
    out.add("messages_dropped_total", "counter",
            "Packets that were replaced by newer ones before they were sent.",
            as_number(counts.dropped));
    out.add("throttled_total", "counter", "Times that a connection was over its budget.",
            as_number(counts.throttled));
    out.begin("cut_off_total", "counter", "Connections that were ended for what they did.");
    out.line("cut_off_total", "{why=\"message\"}", as_number(counts.bad_messages));
    out.line("cut_off_total", "{why=\"flooding\"}", as_number(counts.ended_flooding));
    out.line("cut_off_total", "{why=\"slow\"}", as_number(counts.ended_slow));
    out.line("cut_off_total", "{why=\"full\"}", as_number(counts.refused));
    out.begin("datagrams_total", "counter", "Datagrams of QUIC.");
    out.line("datagrams_total", "{way=\"in\"}", as_number(counts.received_datagrams));
    out.line("datagrams_total", "{way=\"out\"}", as_number(counts.sent_datagrams));
    out.begin("datagram_bytes_total", "counter", "Bytes in them.");
    out.line("datagram_bytes_total", "{way=\"in\"}", as_number(counts.received_datagram_bytes));
    out.line("datagram_bytes_total", "{way=\"out\"}", as_number(counts.sent_datagram_bytes));
    out.begin("datagrams_ignored_total", "counter", "Datagrams that nobody read.");
    out.line("datagrams_ignored_total", "{why=\"stray\"}", as_number(counts.stray_datagrams));
    out.line("datagrams_ignored_total", "{why=\"budget\"}", as_number(counts.unread_datagrams));
    out.line("datagrams_ignored_total", "{why=\"elsewhere\"}", as_number(counts.unread_elsewhere));
    out.line("datagrams_ignored_total", "{why=\"overflow\"}",
             as_number(counts.overflowed_datagrams));
    out.add("retries_total", "counter", "Strangers who had to prove their address first.",
            as_number(counts.retries));
    out.add("queued_bytes_max", "gauge", "The largest queue that a connection has had.",
            static_cast<double>(counts.most_queued_bytes));
}

}  // namespace

std::string MatchServer::metrics() const {
    const hh_match_stats stats = match_.stats();
    Metrics out;
    out.add("tick", "gauge", "The last confirmed tick.", as_number(stats.tick));
    out.add("tick_late_seconds", "gauge", "How far the confirmed ticks are behind the clock.",
            settings_.clock() - start_s_ - as_number(stats.ticks) * settings_.tick_s);
    out.add("slots", "gauge", "Slots of the match.", static_cast<double>(seats_.count()));
    out.add("players", "gauge", "Slots that somebody plays.", static_cast<double>(seats_.taken()));
    out.add("spectators", "gauge", "Peers that watch.", static_cast<double>(seats_.watching()));
    out.add("joins_total", "counter", "Players who joined.", as_number(counts_.joins));
    out.add("returns_total", "counter", "Of these, players who came back.",
            as_number(counts_.returns));
    out.begin("refused_total", "counter", "Peers that were not admitted, by reason.");
    constexpr std::array<std::string_view, k_net_refusals> k_reasons = {
        "",          "version",       "level",    "full",      "no_token",
        "bad_token", "expired_token", "draining", "malformed", "busy"};
    for (std::size_t i = 1; i < k_reasons.size(); ++i) {
        out.line("refused_total", "{why=\"" + std::string(k_reasons[i]) + "\"}",
                 as_number(counts_.refused[i]));
    }
    out.add("inputs_filled_total", "counter", "Inputs that came too late.",
            as_number(stats.filled));
    out.add("hashes_total", "counter", "Hashes of peers that were compared.",
            as_number(stats.hashes));
    out.add("out_of_sync_total", "counter", "Of these, hashes that differed.",
            as_number(stats.out_of_sync));
    out.add("bad_packets_total", "counter", "Packets that were damaged or forged.",
            as_number(counts_.bad_packets));
    out.add("failed_total", "counter", "Connections that ended by a fault of this program.",
            as_number(counts_.failed));
    out.add("states_total", "counter", "States sent to players.", as_number(counts_.states));
    out.begin("state_bytes_total", "counter", "Bytes of these states.");
    out.line("state_bytes_total", "{as=\"made\"}", as_number(counts_.state_bytes));
    out.line("state_bytes_total", "{as=\"sent\"}", as_number(counts_.state_bytes_packed));
    add_traffic(listener_.counts(), out);
    return out.take();
}

HttpAnswer MatchServer::get(std::string_view path) {
    if (path == "/health") {
        return is_draining_ ? HttpAnswer{503, "draining\n"} : HttpAnswer{200, "ok\n"};
    }
    if (path == "/metrics") {
        if (metrics_left_ < 1.0) {
            return {429, "too many requests\n"};
        }
        metrics_left_ -= 1.0;
        return {200, metrics()};
    }
    return {404, "not found: there are /health and /metrics\n"};
}

}  // namespace handhold
