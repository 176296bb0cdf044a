#include <box2d/b2_distance.h>

#include "engine/geometry/disc_contact.hpp"

// The only file that includes Box2D. Its GJK uses floats, with tolerances for bodies of about one
// unit, so segments are passed in centimetres. b2TimeOfImpact is not used: it calls libm's sinf,
// whose last bits differ between processors, and the resulting angles are part of the state.
// close_chain advances with the engine's own rotations instead.
namespace handhold {
namespace {

constexpr double k_units_per_m = 100.0;

b2Vec2 to_box2d(const Vec2& v) {
    return {static_cast<float>(v.x() * k_units_per_m), static_cast<float>(v.y() * k_units_per_m)};
}

b2DistanceProxy proxy_of(const b2Vec2* ends) {
    b2DistanceProxy proxy;
    proxy.Set(ends, 2, 0.0F);  // no radius, unlike Box2D's own shapes
    return proxy;
}

}  // namespace

double disc_distance(const Vec2& a0, const Vec2& a1, const Vec2& b0, const Vec2& b1) {
    // Coordinates are relative to a0, because floats are most precise near zero.
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
