// Skeletons whose nodes are posed in the file are read in the pose of their inverse bind matrices.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "engine/io/gltf_skin.hpp"
#include "tests/engine/io/gltf_builder.hpp"
#include "tests/random.hpp"

namespace handhold::io_gltf_bind_pose_test {
namespace {

using test::GltfBuilder;
using Json = nlohmann::json;

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json numbers(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

// A random skeleton with one triangle per joint, and a rigid mesh at one of them. Node 0 stands
// above the skeleton, node 1 has the skinned mesh, node 2 the rigid one; joint i is node i + 3.
struct Skeleton {
    explicit Skeleton(test::Random& random) {
        const auto count = static_cast<std::size_t>(random.between(2.0, 12.0));
        for (std::size_t i = 0; i < count; ++i) {
            parents.push_back(
                i == 0 ? -1 : static_cast<int>(random.between(0.0, static_cast<double>(i))));
            const Vec3 place = random.arm(0.05, 0.6);
            locals.push_back({place, random.rotation()});
        }
        // Where the topmost joint is posed, a frame that is turned by a little more is its rival.
        const Vec3 axis = random.direction();
        above.rotation = rotation_about(axis, random.between(2.0, 3.1));
        above.position = random.vector(1.0);
    }
    // Of joint i, below node 0.
    Pose bound(std::size_t i) const {
        const Pose local = locals[i];
        return parents[i] < 0 ? local : bound(static_cast<std::size_t>(parents[i])) * local;
    }

    // A file whose nodes are turned and moved against the bound pose by `offsets`. `scale`: of node
    // 0 and so of the whole figure.
    std::string glb(const std::vector<Pose>& offsets, double scale) const {
        GltfBuilder file;
        std::string binds;
        std::vector<std::array<float, 3>> points;
        std::string joints;
        std::string weights;
        for (std::size_t i = 0; i < locals.size(); ++i) {
            const Eigen::Matrix4d matrix = matrix_of(inverse(bound(i)));
            for (Eigen::Index cell = 0; cell < 16; ++cell) {
                append(binds, static_cast<float>(matrix.data()[cell]));
            }
            for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0, 0.1, 0)}) {
                const Vec3 p = transform_point(bound(i), corner);
                points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                                  static_cast<float>(p.z())});
                joints += {static_cast<char>(i), 0, 0, 0};
                for (const float weight : {1.0F, 0.0F, 0.0F, 0.0F}) {
                    append(weights, weight);
                }
            }
        }
        const int positions = file.add_positions(points);
        const int mesh = file.add_mesh(positions, -1);
        Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
        attributes["JOINTS_0"] = file.add_accessor(joints, 5121, "VEC4", points.size());
        attributes["WEIGHTS_0"] = file.add_accessor(weights, 5126, "VEC4", points.size());
        const int rigid = file.add_mesh(file.add_positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), -1);
        Json nodes = Json::array();
        nodes.push_back({{"rotation", numbers(above.rotation)},
                         {"translation", numbers(above.position)},
                         {"scale", {scale, scale, scale}},
                         {"children", {1}}});
        nodes.push_back({{"mesh", mesh}, {"skin", 0}});
        nodes.push_back({{"mesh", rigid}, {"name", "hat"}});
        for (std::size_t i = 0; i < locals.size(); ++i) {
            const Pose posed = locals[i] * offsets[i];
            nodes.push_back({{"name", "joint " + std::to_string(i)},
                             {"translation", numbers(posed.position)},
                             {"rotation", numbers(posed.rotation)}});
            Json& parent = nodes[parents[i] < 0 ? 0U : static_cast<std::size_t>(parents[i]) + 3];
            parent["children"].push_back(i + 3);
            file.json["skins"][0]["joints"].push_back(i + 3);
        }
        nodes[nodes.size() - 1]["children"].push_back(2);
        file.json["nodes"] = nodes;
        file.json["scenes"] = {{{"nodes", {0}}}};
        file.json["skins"][0]["inverseBindMatrices"] =
            file.add_accessor(binds, 5126, "MAT4", locals.size());
        return file.glb();
    }

    std::vector<int> parents;  // of each joint; -1: node 0
    std::vector<Pose> locals;  // in the joint above, as bound
    Pose above;                // of node 0

  private:
    static Eigen::Matrix4d matrix_of(const Pose& pose) {
        Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
        matrix.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
        matrix.topRightCorner<3, 1>() = pose.position;
        return matrix;
    }
    static void append(std::string& bytes, float value) {
        std::array<char, sizeof value> raw{};
        std::memcpy(raw.data(), &value, sizeof value);
        bytes.append(raw.data(), raw.size());
    }
};

// The largest distance between two figures' joints, joints' axes of 1 m and vertices.
double difference_m(const SkinnedMesh& a, const SkinnedMesh& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.joints.size(); ++i) {
        for (const Vec3& point : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
            worst = std::max(worst, (transform_point(a.joints[i].bind_ms, point) -
                                     transform_point(b.joints[i].bind_ms, point))
                                        .norm());
        }
    }
    for (std::size_t i = 0; i < a.positions.size(); ++i) {
        worst = std::max(worst, (a.positions[i] - b.positions[i]).norm());
    }
    return worst;
}

// Every joint in any pose; the topmost one turned by at most 50 degrees, which a figure in a crouch
// or a stride has. The figure is the bound one, bit for bit where nothing is posed.
RC_GTEST_PROP(GltfBindPose, PosedNodesAreReadAsTheMeshWasBound, ()) {
    test::Random random(*rc::gen::arbitrary<std::uint64_t>());
    const Skeleton skeleton(random);
    const double scale = *rc::gen::element(1.0, 0.01, 100.0);
    const std::vector<Pose> none(skeleton.locals.size());
    std::vector<Pose> offsets = none;
    const bool is_top_posed = *rc::gen::arbitrary<bool>();
    for (std::size_t i = is_top_posed ? 0 : 1; i < offsets.size(); ++i) {
        const Vec3 axis = random.direction();
        const double angle = random.between(0.0, i == 0 ? 0.87 : 3.0);
        offsets[i].rotation = rotation_about(axis, angle);
        offsets[i].position = random.vector(i == 0 ? 0.02 : 0.2);
    }
    for (const auto& parse : {parse_gltf_figure, parse_gltf_skin}) {
        const Result<SkinnedMesh> bound = parse(skeleton.glb(none, scale), "bound.glb");
        const Result<SkinnedMesh> posed = parse(skeleton.glb(offsets, scale), "posed.glb");
        RC_ASSERT(bound.ok());
        RC_ASSERT(posed.ok());
        RC_ASSERT(difference_m(bound.value(), posed.value()) < 2e-5 * std::max(1.0, scale));
    }
}

// The joints' places in a bound file come from its nodes, to the last bit.
RC_GTEST_PROP(GltfBindPose, BoundFilesAreReadFromTheirNodes, ()) {
    test::Random random(*rc::gen::arbitrary<std::uint64_t>());
    const Skeleton skeleton(random);
    const Result<SkinnedMesh> read =
        parse_gltf_figure(skeleton.glb(std::vector<Pose>(skeleton.locals.size()), 1.0), "f.glb");
    RC_ASSERT(read.ok());
    for (std::size_t i = 0; i < skeleton.locals.size(); ++i) {
        for (const SkinJoint& joint : read.value().joints) {
            if (joint.name == "joint " + std::to_string(i)) {
                const Pose expected = skeleton.above * skeleton.bound(i);
                RC_ASSERT((joint.bind_ms.position - expected.position).norm() < 1e-12);
            }
        }
    }
}

// Matrices that say nothing: all equal, as exporters write that do not know the bound pose.
TEST(GltfBindPose, EqualMatricesLeaveTheNodesAsTheyAre) {
    test::Random random(1);
    const Skeleton skeleton(random);
    std::vector<Pose> offsets(skeleton.locals.size());
    const Result<SkinnedMesh> bound = parse_gltf_figure(skeleton.glb(offsets, 1.0), "f.glb");
    ASSERT_TRUE(bound.ok());
    std::string bytes = skeleton.glb(offsets, 1.0);
    // The matrices are the last bytes of the file.
    const std::size_t matrix = 64;
    const std::size_t begin = bytes.size() - matrix * offsets.size();
    for (std::size_t i = 1; i < offsets.size(); ++i) {
        bytes.replace(begin + i * matrix, matrix, bytes.substr(begin, matrix));
    }
    const Result<SkinnedMesh> read = parse_gltf_figure(bytes, "f.glb");
    ASSERT_TRUE(read.ok()) << read.error().message();
    for (std::size_t i = 0; i < read.value().joints.size(); ++i) {
        EXPECT_EQ(read.value().joints[i].bind_ms.position,
                  bound.value().joints[i].bind_ms.position);
    }
}

}  // namespace
}  // namespace handhold::io_gltf_bind_pose_test
