#include <box2d/b2_distance.h>

#include "engine/geometry/disc_contact.hpp"

// The only file that names Box2D. Its GJK works in float with tolerances made for moving boxes of
// about a metre: in centimetres a finger is of the size they are made for. b2TimeOfImpact is not
// used: it takes sinf from libm, whose last bits differ between processors, and these angles are
// state; close_chain advances with our own rotations instead.
namespace handhold {
namespace {

constexpr double k_units_per_m = 100.0;

b2Vec2 to_box2d(const Vec2& v) {
    return {static_cast<float>(v.x() * k_units_per_m), static_cast<float>(v.y() * k_units_per_m)};
}

b2DistanceProxy proxy_of(const b2Vec2* ends) {
    b2DistanceProxy proxy;
    proxy.Set(ends, 2, 0.0F);  // no skin: shapes would add 10 mm of it
    return proxy;
}

}  // namespace

double disc_distance(const Vec2& a0, const Vec2& a1, const Vec2& b0, const Vec2& b1) {
    // About a's first end: floats are finest near zero.
    const std::array<b2Vec2, 2> a = {b2Vec2(0.0F, 0.0F), to_box2d(a1 - a0)};
    const std::array<b2Vec2, 2> b = {to_box2d(b0 - a0), to_box2d(b1 - a0)};
    b2DistanceInput input;
    input.proxyA = proxy_of(a.data());
    input.proxyB = proxy_of(b.data());
    input.transformA.SetIdentity();
    input.transformB.SetIdentity();
    input.useRadii = false;
    b2SimplexCache cache;
    cache.count = 0;
    b2DistanceOutput output;
    b2Distance(&output, &cache, &input);
    return static_cast<double>(output.distance) / k_units_per_m;
}

}  // namespace handhold
