#include "game/web/page_match.hpp"

#include <algorithm>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <handhold/math.hpp>

#include "game/levels/built_in_scenes.hpp"
#include "game/mesh/shading_mesh.hpp"
#include "game/net/match_peer.hpp"
#include "game/net/match_scene.hpp"

namespace handhold {
namespace {

using Message = std::vector<std::byte>;

// A connection whose messages JavaScript carries. What a browser's socket cannot take is queued by
// the browser.
class PageLink final : public Link {
  public:
    PageLink(std::deque<Message>& incoming, std::deque<Message>& outgoing,
             std::optional<std::string>& closed)
        : incoming_(incoming), outgoing_(outgoing), closed_(closed) {}

    void poll(double /*wait_s*/, LinkHandler& handler) override {
        while (!incoming_.empty()) {
            const Message message = std::move(incoming_.front());
            incoming_.pop_front();
            handler.received(message);
        }
        if (const auto why = std::exchange(closed_, std::nullopt)) {
            handler.closed(*why);
        }
    }
    void send(Delivery /*delivery*/, std::span<const std::byte> message) override {
        outgoing_.emplace_back(message.begin(), message.end());
    }
    std::size_t queued_bytes() const override { return 0; }
    void close() override {}

  private:
    std::deque<Message>& incoming_;
    std::deque<Message>& outgoing_;
    std::optional<std::string>& closed_;
};

// What all functions of the interface work on.
struct PageMatch {
    std::optional<MatchScene> level;
    std::vector<ShadingMesh> meshes;
    std::vector<PageVisual> visuals;
    std::vector<PageLamp> lamps;
    double now_s = 0.0;
    std::deque<Message> incoming;
    std::deque<Message> outgoing;
    std::optional<std::string> closed;
    Message taken;  // given to JavaScript last
    std::string text;
    std::string defect;           // the peer has thrown
    double given_until_s = 0.0;   // time of the last sample, on the world's clock
    std::int32_t snap_turns = 0;  // turns that no tick has had yet
    std::unique_ptr<MatchPeer> peer;
};

PageMatch& page() {
    static PageMatch page;
    return page;
}

const char* tell(std::string text) {
    page().text = std::move(text);
    return page().text.c_str();
}

PageVisual visual_of(const SceneVisual& visual, const ShadingMesh& mesh, const World& world) {
    const Color& color = visual.color ? *visual.color : visual.mesh->color;
    PageVisual out{};
    out.body = body_id(visual.body);
    out.vertices = mesh.vertices.data();
    out.vertex_count = static_cast<std::uint32_t>(mesh.vertices.size() / 6);
    out.indices = mesh.indices.data();
    out.index_count = static_cast<std::uint32_t>(mesh.indices.size());
    std::ranges::copy(color, std::begin(out.color));
    out.emissive = visual.look.emissive;
    out.opacity = visual.look.opacity;
    out.gloss = visual.look.gloss;
    out.center = to_host(mesh.center);
    out.is_moving = world.body.at(visual.body).kind != BodyKind::fixed ? 1 : 0;
    return out;
}

void prepare_looks(PageMatch& page) {
    const Scene& scene = page.level->scene;
    page.meshes.reserve(scene.visuals.size());
    for (const SceneVisual& visual : scene.visuals) {
        page.meshes.push_back(make_shading_mesh(*visual.mesh));
        page.visuals.push_back(visual_of(visual, page.meshes.back(), scene.world()));
    }
    for (const Lamp& lamp : scene.lamps) {
        page.lamps.push_back({to_host(lamp.position_ws),
                              {lamp.color[0], lamp.color[1], lamp.color[2]},
                              static_cast<float>(lamp.reach_m)});
    }
}

// nullopt: loaded.
std::optional<std::string> load(std::span<const std::byte> message) {
    const std::optional<MatchOffer> offer = read_offer(message);
    if (!offer) {
        return "this is no server of matches";
    }
    if (offer->version != k_net_version) {
        return refusal_text({NetRefusal::version, offer->version});
    }
    std::optional<Scene> scene = make_built_in_scene(offer->scene);
    if (!scene) {
        return "the match is in \"" + printable(offer->scene) + "\", which is not built in";
    }
    Result<MatchScene> made = make_match_scene(std::move(*scene), offer->players, offer->seed);
    if (!made) {
        return made.error().message();
    }
    if (const auto digest = first_difference(offer->digests, made.value().digests)) {
        return refusal_text({NetRefusal::level, static_cast<std::uint16_t>(*digest)});
    }
    page().level = std::move(made.value());
    prepare_looks(page());
    return std::nullopt;
}

std::span<const std::byte> bytes_of(const void* bytes, std::size_t size) {
    return {static_cast<const std::byte*>(bytes), size};
}

// The sample of controllers that has these wrists. `wrists`: as of page_poll.
hh::Sample of_controllers(hh::Sample sample, std::uint32_t wrists) {
    using ::operator*;
    const PageMatch& all = page();
    const hh::Player player = all.level->players[all.peer->slot()];
    for (const hh::Side side : {HH_LEFT, HH_RIGHT}) {
        if ((wrists >> static_cast<unsigned>(side) & 1U) != 0) {
            sample.hands[side] =
                sample.hands[side] *
                hh::inverse(*all.level->scene.host.hand_in_controller(player, side));
        }
    }
    return sample;
}

// Moves the samples to the world's clock, and wrists to controllers.
void give_samples(const hh_match_input& given, std::uint32_t wrists, double end_s,
                  PeerInput& input) {
    PageMatch& all = page();
    const double now_s = end_s + input.later_ticks * k_match_tick_s;
    if (all.given_until_s > now_s + k_match_tick_s) {  // a state has set the clock back
        all.given_until_s = 0.0;
    }
    for (hh::Sample sample : std::span(given.samples, given.sample_count)) {
        sample.time_s += now_s;
        if (sample.time_s <= all.given_until_s) {
            continue;
        }
        all.given_until_s = sample.time_s;
        input.samples.push_back(of_controllers(sample, wrists));
    }
}

MatchPeerSettings settings_of(std::uint64_t person, const char* token) {
    PageMatch& all = page();
    MatchPeerSettings settings;
    settings.digests = all.level->digests;
    settings.person = person;
    settings.token = token;
    settings.tick_s = k_match_tick_s;
    settings.clock = [] { return page().now_s; };
    settings.arena = all.level->scene.arena ? &*all.level->scene.arena : nullptr;
    return settings;
}

}  // namespace

const char* page_load(const void* offer, std::size_t size) {
    try {
        const auto why = load(bytes_of(offer, size));
        return why ? tell(*why) : nullptr;
    } catch (const std::exception& error) {
        return tell(error.what());
    }
}

hh_world* page_world() { return page().level->scene.host.get(); }

const char* page_scene() { return page().level->scene.name.c_str(); }

std::uint32_t page_player_count() {
    return static_cast<std::uint32_t>(page().level->players.size());
}

void page_player(std::uint32_t slot, hh_player* player) { *player = page().level->players[slot]; }

std::uint32_t page_visuals(const PageVisual** visuals) {
    *visuals = page().visuals.data();
    return static_cast<std::uint32_t>(page().visuals.size());
}

std::uint32_t page_lamps(const PageLamp** lamps) {
    *lamps = page().lamps.data();
    return static_cast<std::uint32_t>(page().lamps.size());
}

const char* page_body_name(const hh_body* body) {
    const Scene& scene = page().level->scene;
    const auto& owners = scene.world().body.owners();
    for (std::size_t i = 0; i < owners.size() && i < scene.body_names.size(); ++i) {
        if (body_id(owners[i]) == *body) {
            return scene.body_names[i].c_str();
        }
    }
    return "";
}

void page_connect(std::uint64_t person, const char* token, double now_s) {
    PageMatch& all = page();
    all.now_s = now_s;
    all.incoming.clear();
    all.outgoing.clear();
    all.closed.reset();
    if (all.peer == nullptr) {
        all.peer = std::make_unique<MatchPeer>(all.level->scene.host, all.level->players,
                                               settings_of(person, token));
    }
    all.peer->connect(std::make_unique<PageLink>(all.incoming, all.outgoing, all.closed));
}

void page_receive(const void* message, std::size_t size) {
    const std::span<const std::byte> bytes = bytes_of(message, size);
    page().incoming.emplace_back(bytes.begin(), bytes.end());
}

void page_closed(const char* why) { page().closed = why; }

std::int32_t page_poll(double now_s, const hh_match_input* input, std::uint32_t wrists) {
    PageMatch& all = page();
    all.now_s = now_s;
    all.snap_turns =
        all.peer->stage() == PeerStage::playing ? all.snap_turns + input->commands.snap_turns : 0;
    bool is_given = false;
    try {
        return static_cast<std::int32_t>(
            all.peer->poll(0.0, [&](double end_s, PeerInput& tick_input) {
                tick_input.commands = input->commands;
                tick_input.commands.snap_turns = std::exchange(all.snap_turns, 0);
                tick_input.buttons = input->buttons;
                if (!std::exchange(is_given, true)) {
                    give_samples(*input, wrists, end_s, tick_input);
                }
            }));
    } catch (const std::exception& error) {
        all.defect = error.what();
        return -1;
    }
}

hh_result page_drawn_player(std::uint32_t slot, const hh_tracking_sample* newest,
                            std::uint32_t wrists, hh_pose* origin, hh_pose* head, hh_pose* left,
                            hh_pose* right) {
    const hh::Sample own = newest != nullptr ? of_controllers(*newest, wrists) : hh::sample();
    return hh_match_drawn_player(page_match(), slot, newest != nullptr ? &own : nullptr, origin,
                                 head, left, right);
}

std::size_t page_next_message(const void** message) {
    PageMatch& all = page();
    all.taken.clear();
    if (!all.outgoing.empty()) {
        all.taken = std::move(all.outgoing.front());
        all.outgoing.pop_front();
    }
    *message = all.taken.data();
    return all.taken.size();
}

void page_leave() { page().peer->leave(); }

std::uint32_t page_stage() { return static_cast<std::uint32_t>(page().peer->stage()); }

const char* page_why() {
    const PageMatch& all = page();
    return all.defect.empty() ? all.peer->why().c_str() : all.defect.c_str();
}

std::uint32_t page_may_return() { return page().peer->may_return() ? 1 : 0; }

std::uint32_t page_slot() { return static_cast<std::uint32_t>(page().peer->slot()); }

std::uint32_t page_states() { return static_cast<std::uint32_t>(page().peer->states()); }

const hh_match* page_match() { return std::as_const(*page().peer).match().get(); }

const char* page_score() {
    const auto& arena = page().level->scene.arena;
    return tell(arena ? score_text(arena->state) : "");
}

}  // namespace handhold
