// The station as a level: valid meshes, space for a player, rails that a hand can close around.
#include "game/levels/station.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <gtest/gtest.h>

#include "engine/collision/collision_world.hpp"
#include "game/levels/station_description.hpp"
#include "game/mesh/primitives.hpp"
#include "game/render/figures.hpp"

namespace handhold::station_test {
namespace {

const Structure& station() {
    static const Structure made = make_station();
    return made;
}
const Structure& ship() {
    static const Structure made = make_ship();
    return made;
}

bool is_rail(const Mesh& mesh) { return mesh.name.ends_with("/rails"); }

enum class Count { everything, all_but_rails };

// A structure's surfaces, for queries of the nearest one.
class Surfaces {
  public:
    explicit Surfaces(const Structure& structure) {
        std::vector<ColliderProxy> proxies;
        for (const Mesh& mesh : structure.parts) {
            const std::uint64_t id = proxies.size() + 1;
            proxies.push_back(
                {id, shapes_.add_mesh(std::make_shared<const Mesh>(mesh)), {}, {}, false});
            if (is_rail(mesh)) {
                rails_.push_back(id);
            }
        }
        world_ = std::make_unique<CollisionWorld>(shapes_);
        world_->set_proxies(proxies);
    }
    // Distance from a point to the nearest surface, cut off at `limit_m`.
    double clearance(const Vec3& p, double limit_m, Count count) const {
        const std::optional<SurfacePoint> nearest = world_->closest_point(
            p, limit_m,
            count == Count::everything ? std::span<const std::uint64_t>{}
                                       : std::span<const std::uint64_t>(rails_));
        return nearest ? nearest->distance_m : limit_m;
    }

  private:
    ShapeLibrary shapes_;
    std::vector<std::uint64_t> rails_;
    std::unique_ptr<CollisionWorld> world_;
};

const Surfaces& station_surfaces() {
    static const Surfaces made(station());
    return made;
}
const Surfaces& ship_surfaces() {
    static const Surfaces made(ship());
    return made;
}

// Smallest distance between two straight pieces, to a centimetre.
double distance_between(const HandrailSpan& a, const HandrailSpan& b) {
    double nearest = HUGE_VAL;
    const int steps = static_cast<int>((a.end - a.start).norm() / 0.02) + 1;
    const Vec3 along = b.end - b.start;
    for (int i = 0; i <= steps; ++i) {
        const Vec3 p = a.start + (a.end - a.start) * i / steps;
        const double t = std::clamp((p - b.start).dot(along) / along.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (p - b.start - t * along).norm());
    }
    return nearest - 0.01;
}

double area_m2(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
    const Vec3& a = mesh.positions[t[0]];
    return 0.5 * (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm();
}

// Sums each edge's directed uses: 0 everywhere for closed, consistently wound solids.
bool is_closed(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> walks;
    for (const auto& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i];
            const std::uint32_t b = t[(i + 1) % 3];
            walks[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    }
    return std::all_of(walks.begin(), walks.end(), [](const auto& w) { return w.second == 0; });
}

double volume_m3(const Mesh& mesh) {
    double six_volumes = 0.0;
    for (const auto& t : mesh.triangles) {
        six_volumes += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]]));
    }
    return six_volumes / 6.0;
}

void expect_sound(const Mesh& mesh) {
    SCOPED_TRACE(mesh.name);
    ASSERT_FALSE(mesh.triangles.empty());
    std::set<std::array<double, 3>> places;
    for (const Vec3& p : mesh.positions) {
        ASSERT_TRUE(is_finite(p));
        ASSERT_TRUE(places.insert({p.x(), p.y(), p.z()}).second) << "not welded";
    }
    for (const auto& t : mesh.triangles) {
        ASSERT_LT(std::max({t[0], t[1], t[2]}), mesh.positions.size());
        ASSERT_GT(area_m2(mesh, t), 1e-9);
    }
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_GT(volume_m3(mesh), 0.0) << "inside out";
}

TEST(Station, EveryPartIsWeldedClosedAndWithoutSlivers) {
    for (const Mesh& part : station().parts) {
        expect_sound(part);
    }
    EXPECT_EQ(station().parts.size(), station().looks.size());
}

TEST(Station, HasBetweenEightyAndAHundredAndThirtyThousandTriangles) {
    std::size_t count = 0;
    for (const Mesh& part : station().parts) {
        count += part.triangles.size();
    }
    EXPECT_GE(count, 80000U);
    EXPECT_LE(count, 130000U);
}

TEST(Station, HasAtLeastSixModulesOfFiveKindsAndTenTools) {
    const StationDescription& own = own_station_description();
    std::size_t rooms = 0;
    bool has_truss = false;
    for (const StationSection& section : own.sections) {
        rooms += section.type == SectionType::node || section.type == SectionType::module ? 1 : 0;
        has_truss = has_truss || section.type == SectionType::truss;
    }
    EXPECT_GE(rooms, 6U);
    EXPECT_TRUE(has_truss);
    std::set<ToolType> kinds;
    for (const StationTool& tool : own.tools) {
        kinds.insert(tool.type);
    }
    EXPECT_GE(own.tools.size(), 10U);
    EXPECT_GE(kinds.size(), 10U);
}

TEST(Station, CoordinatesAreExactFloats) {
    for (const Mesh& part : station().parts) {
        for (const Vec3& p : part.positions) {
            for (const double coordinate : p) {
                const volatile float nearest = static_cast<float>(coordinate);
                ASSERT_EQ(coordinate, static_cast<double>(nearest)) << part.name;
            }
        }
    }
}

TEST(Station, StaysWithinItsBounds) {
    for (const Mesh& part : station().parts) {
        for (const Vec3& p : part.positions) {
            ASSERT_LT(std::abs(p.x()), 11.6) << part.name;
            ASSERT_LT(std::abs(p.y()), 4.9) << part.name;
            ASSERT_LT(std::abs(p.z()), 7.7) << part.name;
        }
    }
}

TEST(Station, PartNamesAreSectionAndMaterialAndOccurOnce) {
    std::set<std::string> names;
    for (const Mesh& part : station().parts) {
        EXPECT_TRUE(names.insert(part.name).second) << part.name;
        EXPECT_EQ(std::count(part.name.begin(), part.name.end(), '/'), 1) << part.name;
    }
    for (const char* section :
         {"hab", "lab", "airlock", "node", "junction", "greenhouse", "storage"}) {
        EXPECT_TRUE(names.contains(std::string(section) + "/panels"));
    }
}

TEST(Station, IsTheSameEveryTime) {
    const Structure again = make_station();
    ASSERT_EQ(again.parts.size(), station().parts.size());
    for (std::size_t i = 0; i < again.parts.size(); ++i) {
        EXPECT_EQ(again.parts[i].triangles, station().parts[i].triangles);
        EXPECT_EQ(again.parts[i].positions, station().parts[i].positions);
    }
}

TEST(Station, SpawnsAreThirtyCentimetresClear) {
    ASSERT_GE(station().spawns.size(), 10U);
    for (const SpawnPoint& spawn : station().spawns) {
        EXPECT_TRUE(is_valid(spawn.pose)) << spawn.name;
        EXPECT_GE(station_surfaces().clearance(spawn.pose.position, 0.5, Count::everything), 0.3)
            << spawn.name;
    }
}

// Along the axes of all modules, through every hatchway, to half a metre from their ends. Tools
// float elsewhere.
TEST(Station, WayFromModuleToModuleIsHalfAMetreClear) {
    const auto expect_clear = [](const Vec3& from, const Vec3& to) {
        const int steps = static_cast<int>((to - from).norm() / 0.1);
        for (int i = 0; i <= steps; ++i) {
            const Vec3 p = from + (to - from) * i / steps;
            EXPECT_GE(station_surfaces().clearance(p, 0.6, Count::everything), 0.5)
                << p.transpose();
        }
    };
    expect_clear(Vec3(-8.4, 0.0, 0.0), Vec3(6.0, 0.0, 0.0));  // out of the open airlock
    expect_clear(Vec3::Zero(), Vec3(0.0, 0.0, 6.4));
    expect_clear(Vec3(-7.94, 0.0, -4.3), Vec3(-7.94, 0.0, 4.3));
}

// Except the posts and ends of the rail itself.
TEST(Station, RailsAreFourCentimetresClearOfEverythingElse) {
    ASSERT_GE(station().rails.size(), 60U);
    for (const HandrailSpan& rail : station().rails) {
        const int steps = static_cast<int>((rail.end - rail.start).norm() / 0.02) + 1;
        for (int i = 0; i <= steps; ++i) {
            const Vec3 p = rail.start + (rail.end - rail.start) * i / steps;
            EXPECT_GE(station_surfaces().clearance(p, 0.1, Count::all_but_rails),
                      rail.radius_m + 0.04)
                << rail.name << " at " << p.transpose();
        }
        for (const HandrailSpan& other : station().rails) {
            if (rail.name != other.name) {
                EXPECT_GE(distance_between(rail, other), rail.radius_m + other.radius_m + 0.04)
                    << rail.name << " and " << other.name;
            }
        }
    }
}

TEST(Station, RailSpansLieOnTheirBars) {
    for (const HandrailSpan& rail : station().rails) {
        const Vec3 middle = 0.37 * rail.start + 0.63 * rail.end;
        // The bar is a ten-sided prism: its surface lies between both radii from the axis, unless a
        // post is near.
        EXPECT_LE(station_surfaces().clearance(middle, 0.1, Count::everything),
                  rail.radius_m + 1e-9)
            << rail.name;
    }
}

TEST(Station, EachModuleHasAStraightRailAlongItsWholeLength) {
    for (const char* module : {"hab/", "lab/", "airlock/", "greenhouse/", "storage/"}) {
        const bool has_long = std::any_of(
            station().rails.begin(), station().rails.end(), [&](const HandrailSpan& rail) {
                return rail.name.starts_with(module) && (rail.end - rail.start).norm() >= 2.8;
            });
        EXPECT_TRUE(has_long) << module;
    }
    EXPECT_EQ(station_rails().size(), station().rails.size());
}

TEST(Ship, IsSoundAndFillsItsBox) {
    Vec3 low = Vec3::Constant(HUGE_VAL);
    Vec3 high = -low;
    for (const Mesh& part : ship().parts) {
        expect_sound(part);
        for (const Vec3& p : part.positions) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    }
    EXPECT_NEAR(high.x() - low.x(), 4.0, 0.2);
    EXPECT_NEAR(high.y() - low.y(), 3.0, 0.2);
    EXPECT_NEAR(high.z() - low.z(), 8.0, 0.2);
    EXPECT_LT((0.5 * (low + high)).norm(), 0.2);
}

TEST(Ship, RailsAndSpawnsAreClear) {
    for (const HandrailSpan& rail : ship().rails) {
        const int steps = static_cast<int>((rail.end - rail.start).norm() / 0.02) + 1;
        for (int i = 0; i <= steps; ++i) {
            const Vec3 p = rail.start + (rail.end - rail.start) * i / steps;
            ASSERT_GE(ship_surfaces().clearance(p, 0.1, Count::all_but_rails), rail.radius_m + 0.03)
                << rail.name;
        }
    }
    for (const SpawnPoint& spawn : ship().spawns) {
        EXPECT_GE(ship_surfaces().clearance(spawn.pose.position, 0.5, Count::everything), 0.3);
    }
}

TEST(Rock, IsAboutSixteenCentimetresAcross) {
    const Mesh rock = make_held_rock();
    expect_sound(rock);
    Vec3 low = Vec3::Constant(HUGE_VAL);
    Vec3 high = -low;
    for (const Vec3& p : rock.positions) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    EXPECT_NEAR((high - low).maxCoeff(), 0.16, 0.03);
    EXPECT_NEAR((high - low).minCoeff(), 0.16, 0.05);
}

// Closed forms: inscribed polygons and polyhedra of n segments lose a known share of the round
// volume.
TEST(Primitives, AreClosedAndHaveTheVolumeOfTheirFormula) {
    const auto polygon_share = [](int n) { return std::sin(2.0 * k_pi / n) * n / (2.0 * k_pi); };
    const std::array<Vec3, 3> bent = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)};
    const struct {
        const char* name;
        Mesh mesh;
        double volume_m3;
        double tolerance;
    } cases[] = {
        {"box", make_box(Vec3(0.5, 1.0, 1.5)), 6.0, 1e-12},
        {"bevelled box", make_bevelled_box(Vec3(0.5, 0.5, 0.5), 0.1),
         // a cube without twelve triangular bars of length 0.8 and eight corners of three tenths by
         // half a tenth
         1.0 - 12.0 * 0.8 * 0.005 - 8.0 * 0.1 * 0.1 * 0.1 * 5.0 / 6.0, 1e-9},
        {"slab", make_bevelled_slab(Vec3(0.5, 0.5, 0.5), 0.1), 0.9 + 0.1 * (1.0 + 0.8 + 0.64) / 3.0,
         1e-9},  // prism and frustum
        {"cylinder", make_cylinder(Vec3(1, 2, 3), Vec3(1, 2, 5), 0.5, 24),
         2.0 * 0.25 * k_pi * polygon_share(24), 1e-9},
        {"sphere", make_sphere(1.0, 96), 4.0 / 3.0 * k_pi, 0.02},
        {"icosphere", make_icosphere(1.0, 4), 4.0 / 3.0 * k_pi, 0.02},
        {"capsule", make_capsule(Vec3(0, 0, 0), Vec3(0, 2, 0), 0.5, 96),
         2.0 * 0.25 * k_pi + k_pi / 6.0, 0.02},
        {"torus", make_torus(1.0, 0.2, 128, 64), 2.0 * k_pi * k_pi * 0.04, 0.005},
        {"bent tube", make_tube(bent, 0.1, 24), 2.0 * 0.01 * k_pi * polygon_share(24), 1e-3},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.name);
        EXPECT_TRUE(is_closed(c.mesh));
        EXPECT_NEAR(volume_m3(c.mesh), c.volume_m3, c.tolerance);
    }
}

TEST(Primitives, LookAlongTurnsMinusZForward) {
    const Vec3 forward = Vec3(1.0, -0.5, 2.0).normalized();
    const Pose pose = look_along(Vec3(1, 2, 3), forward, Vec3::UnitY());
    EXPECT_LT((pose.rotation * Vec3(0, 0, -1) - forward).norm(), 1e-12);
    EXPECT_NEAR((pose.rotation * Vec3::UnitX()).y(), 0.0, 1e-12);
    EXPECT_GT((pose.rotation * Vec3::UnitY()).y(), 0.0);
}

}  // namespace
}  // namespace handhold::station_test
