// The inspector's words about a player's size, compared with the columns.
#include "game/view/explain_size.hpp"

#include <gtest/gtest.h>

#include "game/play/desktop_session.hpp"
#include "tests/game/climber/climber_scene.hpp"

namespace handhold::explain_size_test {
namespace {

struct Playing : DesktopSession {
    Playing() : DesktopSession(make_tunnel(6.0), hh::pose_at({-0.45, 0.35 - 1.6, 2.0})) {}

    void run(double seconds) {
        for (double t_s = 0.0; t_s < seconds; t_s += k_dt_s) {
            step({});
        }
    }
    Entity entity() const { return player_entities(scene().world(), player()).player; }
    SizeStory story() const { return explain_size(scene().world(), entity()); }
};

TEST(ExplainSize, NamesMeasuresAndHowLongPlayWasSeen) {
    Playing session;
    session.run(0.2);
    EXPECT_NE(session.story().reason.find("too little"), std::string::npos);
    session.run(40.0);
    const SizeStory story = session.story();
    EXPECT_NE(
        story.reason.find("From play that counts: head seen for 40 s, hands for 80 hand-seconds"),
        std::string::npos)
        << story.reason;
    const BodyMeasures& believed = session.scene().world().body_measures.at(session.entity());
    EXPECT_EQ(story.eye_height_m, believed.eye_height_m);
    EXPECT_EQ(story.arm_m, believed.upper_arm_m + believed.forearm_m);
    EXPECT_EQ(story.shoulder_width_m, believed.shoulder_width_m);
}

TEST(ExplainSize, SaysWhoMeasuredThePlayer) {
    const Playing session;
    World world = session.scene().world();
    const Entity player = session.entity();
    world.size_estimate.at(player).is_measured = true;
    EXPECT_EQ(explain_size(world, player).reason, "Given by the host, or measured before.");
    world.calibration.at(player).done = true;
    EXPECT_EQ(explain_size(world, player).reason, "Measured in a T-pose.");
}

// A player of an unusual size is told to be on the way there.
TEST(ExplainSize, SaysWhereChangingMeasuresGo) {
    Playing session;
    session.run(3.0);
    World world = session.scene().world();
    world.body_measures.at(session.entity()).eye_height_m = 1.2;
    EXPECT_NE(explain_size(world, session.entity()).reason.find("on the way to eyes at 1.6"),
              std::string::npos)
        << explain_size(world, session.entity()).reason;
}

}  // namespace
}  // namespace handhold::explain_size_test
