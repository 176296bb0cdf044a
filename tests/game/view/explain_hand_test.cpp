// The inspector's explanation of a hand, compared with what the hand then does.
#include "game/view/explain_hand.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "game/play/desktop_session.hpp"
#include "game/play/play_tally.hpp"
#include "game/view/explain_fit.hpp"
#include "game/view/gizmos.hpp"
#include "tests/game/climber/climber_scene.hpp"

namespace handhold::explain_hand_test {
namespace {

// A tunnel whose rail has grip meshes.
Scene make_fitted_tunnel() {
    Scene scene = make_tunnel(6.0);
    add_grip_meshes(scene);
    return scene;
}

// Beside the tunnel's rail, looking at it; the left hand rests in front of the player.
struct AtRail : DesktopSession {
    AtRail() : DesktopSession(make_fitted_tunnel(), hh::pose_at({-0.45, 0.35 - 1.6, 2.0})) {
        DesktopInput look;
        look.turn_left_rad = 0.9;
        look.look_up_rad = -0.2;
        step(look);
        run({}, 0.3);
    }
    void run(const DesktopInput& input, double seconds) {
        for (double t_s = 0.0; t_s < seconds; t_s += k_dt_s) {
            step(input);
        }
    }
    // The left hand closes on the rail.
    void grip(double seconds) {
        DesktopInput closed;
        closed.grip[0] = true;
        run(closed, seconds);
    }
    std::vector<Line> lines_of(const GizmoSet& on) const {
        std::vector<Line> lines;
        add_gizmos(scene().world(), scene().caches(), scene().tuning(), on, lines);
        return lines;
    }
    std::vector<Line> lines_of(Gizmo gizmo) const {
        GizmoSet on = k_no_gizmos;
        on[static_cast<std::size_t>(gizmo)] = true;
        return lines_of(on);
    }
    HandStory story(HandSide side) const {
        return explain_hand(scene(), scene().caches().collision, entities().hands[index_of(side)]);
    }
    PlayerEntities entities() const {
        return player_entities(scene().world(), DesktopSession::player());
    }
};

bool says(const HandStory& story, const std::string& words) {
    for (const std::string& reason : story.reasons) {
        if (reason.find(words) != std::string::npos) {
            return true;
        }
    }
    return story.headline.find(words) != std::string::npos;
}

TEST(ExplainHand, OpenHandInTheAirNamesTheNearestSurfaceAndItsDistance) {
    AtRail desk;
    const HandStory story = desk.story(HandSide::right);
    EXPECT_TRUE(says(story, "is open"));
    EXPECT_TRUE(says(story, "farther than hand.reach_m, 10 cm"));
}

TEST(ExplainHand, GrippingHandNamesTheBodyAndItsError) {
    AtRail desk;
    desk.grip(0.7);
    const Grab& grab = desk.scene().world().grab.at(desk.entities().hands[0]);
    ASSERT_EQ(grab.kind, GripKind::surface);
    const HandStory story = desk.story(HandSide::left);
    const std::string name = name_of_entity(desk.scene(), grab.body);
    EXPECT_EQ(find_by_id(desk.scene().world(), persistent_id_from_name(name)), grab.body);
    EXPECT_TRUE(says(story, "grips " + name));
    EXPECT_TRUE(says(story, "It is fixed"));
    EXPECT_TRUE(says(story, "hand.max_stretch_m"));
}

TEST(ExplainHand, HandClosedOnNothingMustOpenFirst) {
    AtRail desk;
    DesktopInput away;
    away.turn_left_rad = 3.14 - 0.9 + 0.6;  // down the middle of the tunnel
    desk.step(away);
    DesktopInput grip;
    grip.grip[1] = true;
    desk.run(grip, 1.0);
    ASSERT_EQ(desk.scene().world().grab.at(desk.entities().hands[1]).kind, GripKind::none);
    const HandStory story = desk.story(HandSide::right);
    EXPECT_TRUE(says(story, "closed on nothing"));
    EXPECT_TRUE(says(story, "Open it first"));
}

TEST(ExplainHand, HandInTheLineOfSightIsPointedAt) {
    AtRail desk;
    const RenderPose& render = desk.scene().world().render_pose.at(desk.entities().player);
    for (std::size_t side = 0; side < k_hand_count; ++side) {
        const Vec3 to = render.hands[side].shown_ws.position - render.head_ws.position;
        EXPECT_EQ(hand_pointed_at(desk.scene().world(), render.head_ws.position, to.normalized()),
                  desk.entities().hands[side]);
    }
    EXPECT_FALSE(hand_pointed_at(desk.scene().world(), render.head_ws.position, Vec3::UnitY()));
}

TEST(Gizmos, EachGizmoDrawsLinesAndNoneDrawsNothing) {
    AtRail desk;
    desk.grip(0.7);
    EXPECT_TRUE(desk.lines_of(k_no_gizmos).empty());
    for (const Gizmo gizmo : {Gizmo::tracked_hands, Gizmo::palm_rays, Gizmo::grips, Gizmo::islands,
                              Gizmo::search, Gizmo::palm_limits, Gizmo::fingers, Gizmo::fit}) {
        const std::vector<Line> lines = desk.lines_of(gizmo);
        EXPECT_FALSE(lines.empty()) << info_of(gizmo).name;
        for (const Line& line : lines) {
            EXPECT_TRUE(line.a_ws.allFinite() && line.b_ws.allFinite());
        }
    }
}

// The grip's normal starts on the bar's surface, at the point of the hand's constraint.
TEST(Gizmos, GripIsDrawnOnTheHeldSurface) {
    AtRail desk;
    desk.grip(0.7);
    const std::vector<Line> lines = desk.lines_of(Gizmo::grips);
    ASSERT_FALSE(lines.empty());
    const Line& normal = lines.back();
    const auto nearest = desk.scene().caches().collision.closest_point(normal.a_ws, 0.1);
    ASSERT_TRUE(nearest);
    EXPECT_LT(nearest->distance_m, 1e-6);
    EXPECT_NEAR((normal.b_ws - normal.a_ws).norm(), 0.08, 1e-9);
}

// Fingers around the bar: drawn contacts lie on the bar.
TEST(Gizmos, FingerContactsLieOnTheSurface) {
    AtRail desk;
    desk.grip(1.0);
    const std::vector<Line> lines = desk.lines_of(Gizmo::fingers);
    int touches = 0;
    for (const Line& line : lines) {
        const auto nearest = desk.scene().caches().collision.closest_point(line.b_ws, 1e-3);
        const bool is_short = (line.b_ws - line.a_ws).norm() < 0.02;
        touches += nearest && nearest->distance_m < 1e-4 && is_short ? 1 : 0;
    }
    EXPECT_GT(touches, 3);
}

// Only a gripping hand has terms; looking at them changes nothing.
TEST(Gizmos, FitColoursAreThoseOfTheCostliestTerms) {
    AtRail desk;
    desk.grip(0.7);
    const World& world = desk.scene().world();
    const std::uint64_t hash = hash_state(world);
    const auto terms_of = [&](HandSide side) {
        return fit_terms_of(world, desk.scene().caches(), desk.scene().tuning(),
                            desk.entities().hands[index_of(side)]);
    };
    EXPECT_FALSE(terms_of(HandSide::right));
    const auto terms = terms_of(HandSide::left);
    ASSERT_TRUE(terms);
    const std::vector<Line> lines = desk.lines_of(Gizmo::fit);
    std::vector<Color> wanted = {color_of(FitTerm::sync)};  // of the palm's line
    for (const FitTerms::Costs& costs : terms->cost_m2) {
        const auto term = shaping_term(costs);
        wanted.push_back(term ? color_of(*term) : k_at_ease);
    }
    for (const Color& color : wanted) {
        EXPECT_TRUE(std::ranges::any_of(lines, [&](const Line& l) { return l.color == color; }));
    }
    for (const Line& line : lines) {
        EXPECT_NE(std::ranges::find(wanted, line.color), wanted.end());
    }
    EXPECT_EQ(hash_state(world), hash);
}

TEST(ExplainFit, EveryTermHasAMeaningAndAColourOfItsOwn) {
    for (std::size_t i = 0; i < k_fit_term_count; ++i) {
        const auto term = static_cast<FitTerm>(i);
        ASSERT_NE(meaning_of(term), nullptr) << name_of(term);
        for (std::size_t other = 0; other < i; ++other) {
            EXPECT_NE(color_of(term), color_of(static_cast<FitTerm>(other))) << name_of(term);
        }
    }
}

TEST(PlayTally, ClimbedDistanceExcludesDrifting) {
    AtRail desk;
    PlayTally tally;
    const auto play = [&](const DesktopInput& input, double seconds) {
        for (double t_s = 0.0; t_s < seconds; t_s += DesktopSession::k_dt_s) {
            desk.step(input);
            tally.add_frame(desk.world(), desk.player(), 100.0, DesktopSession::k_dt_s);
        }
    };
    DesktopInput input;
    input.grip[0] = true;
    play(input, 0.6);
    const double before_m = tally.figures().climbed_m;
    input.move = {0.0, 0.0, -1.0};
    play(input, 0.3);
    EXPECT_NEAR(tally.figures().climbed_m - before_m, 0.9 * 0.3, 0.03);  // a pull of 0.9 m/s
    play({}, 0.5);                                                       // the player glides on
    EXPECT_EQ(tally.figures().grips, 1U);
    EXPECT_EQ(tally.figures().hand_changes, 0U);
    EXPECT_GT(tally.figures().path_m, tally.figures().climbed_m + 0.2);
    EXPECT_NEAR(tally.figures().played_s, 1.4, 0.05);
}

}  // namespace
}  // namespace handhold::explain_hand_test
