// Recomputes the figures from the two output files alone, with independent quaternion and joint
// code.
#include <algorithm>
#include <cmath>

#include "lab_files.hpp"

namespace handhold::lab::lab_reader_test {
namespace {

using V = std::array<double, 3>;
using Q = std::array<double, 4>;  // x y z w

V sub(const V& a, const V& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
V add(const V& a, const V& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
V cross(const V& a, const V& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const V& a) { return std::sqrt(dot(a, a)); }
V turn(const Q& q, const V& v) {
    const V axis = {q[0], q[1], q[2]};
    const V once = cross(axis, v);
    const V twice = cross(axis, once);
    return {v[0] + 2.0 * (q[3] * once[0] + twice[0]), v[1] + 2.0 * (q[3] * once[1] + twice[1]),
            v[2] + 2.0 * (q[3] * once[2] + twice[2])};
}

struct Frame {
    V position = {0.0, 0.0, 0.0};
    Q rotation = {0.0, 0.0, 0.0, 1.0};
};

Frame frame_of(const nlohmann::json& json) {
    return {json["position_m"].get<V>(), json["rotation_xyzw"].get<Q>()};
}
Frame frame_of(const CsvRow& row) {
    const auto& n = row.numbers;
    return {{n[0], n[1], n[2]}, {n[3], n[4], n[5], n[6]}};
}
V point(const Frame& body, const nlohmann::json& local) {
    return add(body.position, turn(body.rotation, frame_of(local).position));
}
V axis(const Frame& body, const nlohmann::json& local) {
    return turn(body.rotation, turn(frame_of(local).rotation, {1.0, 0.0, 0.0}));
}

// Worst errors over all frames, in the file's units.
struct Errors {
    double joint_mm = 0.0;
    double joint_deg = 0.0;
    double grab_mm = 0.0;
};

void take_joint(const nlohmann::json& joint, const std::map<std::string, Frame>& poses,
                Errors& errors) {
    const auto body = [&poses](const nlohmann::json& id) {
        return id == -1 ? Frame{} : poses.at(std::to_string(id.get<int>()));
    };
    const Frame a = body(joint["a"]);
    const Frame b = body(joint["b"]);
    const V apart = sub(point(b, joint["frame_b"]), point(a, joint["frame_a"]));
    const V along = axis(a, joint["frame_a"]);
    const double askew = std::asin(std::min(1.0, length(cross(along, axis(b, joint["frame_b"])))));
    const bool slides = joint["type"] == "slider";
    double point_m = slides ? length(cross(along, apart)) : length(apart);
    if (slides) {
        const double travel = dot(along, apart);
        point_m = std::max({point_m, travel - joint["upper"].get<double>(),
                            joint["lower"].get<double>() - travel});
    }
    errors.joint_mm = std::max(errors.joint_mm, 1e3 * point_m);
    if (joint["type"] != "ball") {
        errors.joint_deg = std::max(errors.joint_deg, askew * 180.0 / std::acos(-1.0));
    }
}

Errors recompute(const nlohmann::json& json, const std::vector<CsvRow>& rows) {
    Errors errors;
    std::map<std::string, Frame> poses;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        poses[rows[i].body] = frame_of(rows[i]);
        const bool frame_ends = i + 1 == rows.size() || rows[i + 1].frame != rows[i].frame;
        if (!frame_ends) {
            continue;
        }
        for (std::size_t j = 0; j < json["joints"].size(); ++j) {
            const nlohmann::json& joint = json["joints"][j];
            if (joint["type"] != "grab") {
                take_joint(joint, poses, errors);
                continue;
            }
            const auto target = poses.find("grab" + std::to_string(j));
            if (target != poses.end()) {
                const Frame& held = poses.at(std::to_string(joint["b"].get<int>()));
                const V apart = sub(target->second.position, point(held, joint["frame_b"]));
                errors.grab_mm = std::max(errors.grab_mm, 1e3 * length(apart));
            }
        }
        poses.clear();
    }
    return errors;
}

class LabReader : public LabTest {
  protected:
    void expect_same(const std::string& scene, const std::string& holder,
                     const std::string& solver) const {
        SCOPED_TRACE(scene + " " + holder + " " + solver);
        SolveOptions run_options = options(scene, 60);
        run_options.links = 12;
        run_options.holder = holder;
        run_options.solver = solver;
        run_options.csv = folder_ / "out.csv";
        const nlohmann::json json = solve(run_options);
        const std::vector<CsvRow> rows = parse_rows(text_of(run_options.csv));
        ASSERT_EQ(rows.back().frame, 59);
        const Errors errors = recompute(json, rows);
        const auto same = [](double again, const nlohmann::json& said) {
            EXPECT_NEAR(again, said["max"].get<double>(), 1e-9 + 1e-6 * again);
        };
        same(errors.joint_mm, json["joint_error_mm"]);
        same(errors.grab_mm, json["grab_error_mm"]);
        if (scene == "lever") {
            same(errors.joint_deg, json["joint_error_deg"]);
        }
    }
};

TEST_F(LabReader, ErrorsRecomputedFromTheFilesAgree) {
    for (const char* scene : {"chain", "lever", "drawer"}) {
        for (const char* holder : {"player", "kinematic"}) {
            expect_same(scene, holder, "direct");
        }
    }
    // Solvers whose errors are large enough to see.
    expect_same("chain", "kinematic", "plain");
    expect_same("chain", "player", "bullet");
}

TEST_F(LabReader, PlayerRowsHaveTheOriginInEveryFrame) {
    SolveOptions run_options = options("chain", 120);
    run_options.csv = folder_ / "out.csv";
    const nlohmann::json json = solve(run_options);
    const auto& bodies = json["bodies"];
    ASSERT_EQ(bodies.back()["kind"], "player");
    const std::string player = std::to_string(bodies.back()["id"].get<int>());
    int found = 0;
    for (const CsvRow& row : parse_rows(text_of(run_options.csv))) {
        if (row.body == player) {
            ++found;
            EXPECT_EQ((V{row.numbers[0], row.numbers[1], row.numbers[2]}), (V{0.0, 0.0, 0.0}));
        }
    }
    EXPECT_EQ(found, 120);
}

TEST_F(LabReader, HeldRockNeverPenetratesTheWall) {
    SolveOptions run_options = options("shove", 90);
    run_options.csv = folder_ / "out.csv";
    const nlohmann::json json = solve(run_options);
    ASSERT_EQ(json["planes"][0]["normal"].get<V>(), (V{1.0, 0.0, 0.0}));
    const nlohmann::json& rock = json["bodies"][1];
    const V half = rock["half_m"].get<V>();
    double deepest = 0.0;
    for (const CsvRow& row : parse_rows(text_of(run_options.csv))) {
        if (row.body != "1") {
            continue;
        }
        for (int corner = 0; corner < 8; ++corner) {
            const V local = {(corner & 1) != 0 ? half[0] : -half[0],
                             (corner & 2) != 0 ? half[1] : -half[1],
                             (corner & 4) != 0 ? half[2] : -half[2]};
            const Frame pose = frame_of(row);
            deepest = std::max(deepest, -add(pose.position, turn(pose.rotation, local))[0]);
        }
    }
    EXPECT_NEAR(1e3 * deepest, json["penetration_mm"]["max"].get<double>(), 1e-9);
    EXPECT_LE(1e3 * deepest, 1e-3);
}

}  // namespace
}  // namespace handhold::lab::lab_reader_test
