#include "game/scene/overlaps.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

#include "game/scene/player_defaults.hpp"

namespace handhold {
namespace {

constexpr double k_noticed_m = 0.005;

class OverlapFinder {
  public:
    explicit OverlapFinder(Scene& scene) : scene_(scene), collision_(scene.caches().collision) {
        for (std::size_t index = 0; index < scene.world().body.size(); ++index) {
            const std::uint64_t id =
                scene.world().persistent_id.at(scene.world().body.owners()[index]).value;
            name_of_id_[id] =
                index < scene.body_names.size() ? scene.body_names[index] : std::string("a body");
        }
        scene.host.closest_point({}, 0.0);  // a query places all colliders
    }

    void add_bodies() {
        std::vector<ContactPoint> contacts;
        collision_.set_ignored_pairs({});
        collision_.find_contacts({}, contacts);
        // Deepest contact, by pair of ids.
        std::map<std::pair<std::uint64_t, std::uint64_t>, double> depth_m;
        for (const ContactPoint& contact : contacts) {
            double& deepest_m = depth_m[{contact.id_a, contact.id_b}];
            deepest_m = std::max(deepest_m, -contact.separation_m);
        }
        for (const auto& [ids, deepest_m] : depth_m) {
            if (!are_tied(ids.first, ids.second)) {
                add(name_of(ids.first), name_of(ids.second), deepest_m);
            }
        }
    }

    void add_heads(const std::vector<PlayerEntities>& players) {
        const double radius_m = scene_.tuning().head.radius_m;
        std::vector<Vec3> heads;
        for (const PlayerEntities& player : players) {
            const Pose& origin_ws = scene_.world().player_origin.at(player.player).pose_ws;
            heads.push_back(transform_point(origin_ws, Vec3(0.0, k_eye_height_m, 0.0)));
        }
        for (std::size_t i = 0; i < heads.size(); ++i) {
            const std::string name = "the head of player " + std::to_string(i);
            if (const auto hit = collision_.closest_point(heads[i], radius_m)) {
                add(name, name_of(hit->id), radius_m - hit->distance_m);
            }
            for (std::size_t j = 0; j < i; ++j) {
                add(name, "the head of player " + std::to_string(j),
                    2.0 * radius_m - (heads[i] - heads[j]).norm());
            }
        }
    }

    std::vector<SpawnOverlap> take() {
        std::ranges::stable_sort(found_, std::ranges::greater(), &SpawnOverlap::depth_m);
        return std::move(found_);
    }

  private:
    void add(const std::string& a, const std::string& b, double depth_m) {
        if (depth_m > k_noticed_m) {
            found_.push_back({a, b, depth_m});
        }
    }
    std::string name_of(std::uint64_t id) const {
        const auto found = name_of_id_.find(id);
        return found != name_of_id_.end() ? found->second : std::string("a player");
    }
    bool are_tied(std::uint64_t a, std::uint64_t b) const {
        const World& world = scene_.world();
        const Entity first = find_by_id(world, PersistentId{a});
        const Entity second = find_by_id(world, PersistentId{b});
        return std::ranges::any_of(world.joints_by_body.of(first), [&](Entity entity) {
            const Joint& joint = world.joint.at(entity);
            return joint.a == second || joint.b == second;
        });
    }

    const Scene& scene_;
    CollisionWorld& collision_;
    std::unordered_map<std::uint64_t, std::string> name_of_id_;
    std::vector<SpawnOverlap> found_;
};

}  // namespace

std::vector<SpawnOverlap> find_overlaps(Scene& scene, const std::vector<PlayerEntities>& players) {
    OverlapFinder finder(scene);
    finder.add_bodies();
    finder.add_heads(players);
    return finder.take();
}

}  // namespace handhold
