// The formula dialect over sixteen lanes, on the types of lanes-inl.h: each lane does the operations of
// scalar.h in order, bit-identically. Compiled once per target by Highway, inside HWY_NAMESPACE.
#if defined(RELIEF_MATH_WIDE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELIEF_MATH_WIDE_INL_H
#undef RELIEF_MATH_WIDE_INL_H
#else
#define RELIEF_MATH_WIDE_INL_H
#endif

#include <limits>

#include "formulas/constants.h"
#include "formulas/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace relief::HWY_NAMESPACE::wide {

/// One boolean per lane.
struct Bool {
    hn::Mask<Float::D> part[Float::kParts];
};

#define RELIEF_WIDE_COMPARE(name, function)                                                                  \
    RELIEF_INLINE Bool name(const Float& a, const Float& b) {                                                \
        RELIEF_RETURN_PARTS(Bool, hn::function(a.part[p], b.part[p]));                                       \
    }
RELIEF_WIDE_COMPARE(operator<, Lt)
RELIEF_WIDE_COMPARE(operator<=, Le)
RELIEF_WIDE_COMPARE(operator>, Gt)
RELIEF_WIDE_COMPARE(operator>=, Ge)
RELIEF_WIDE_COMPARE(operator==, Eq)
#undef RELIEF_WIDE_COMPARE

/// Lanes with a nonzero value.
RELIEF_INLINE Bool is_set(const float* aligned) {
    const Float value = Float::load(aligned), zero(0.0f);
    RELIEF_RETURN_PARTS(Bool, hn::Ne(value.part[p], zero.part[p]));
}

#define RELIEF_WIDE_LOGIC(name, function)                                                                    \
    RELIEF_INLINE Bool name(const Bool& a, const Bool& b) {                                                  \
        RELIEF_RETURN_PARTS(Bool, hn::function(a.part[p], b.part[p]));                                       \
    }
RELIEF_WIDE_LOGIC(operator&&, And)
RELIEF_WIDE_LOGIC(operator||, Or)
#undef RELIEF_WIDE_LOGIC

RELIEF_INLINE Bool operator!(const Bool& a) { RELIEF_RETURN_PARTS(Bool, hn::Not(a.part[p])); }

RELIEF_INLINE LaneMask to_mask(const Bool& b) {
    LaneMask bits = 0;
    for (size_t p = 0; p < Float::kParts; ++p) bits |= to_bits(Float::D(), b.part[p]) << (p * Float::kLanes);
    return bits;
}

RELIEF_INLINE bool is_any(const Bool& b) {
    bool any = false;
    for (size_t p = 0; p < Float::kParts; ++p) any = any || !hn::AllFalse(Float::D(), b.part[p]);
    return any;
}

RELIEF_INLINE Float select(const Bool& condition, const Float& a, const Float& b) {
    RELIEF_RETURN_PARTS(Float, hn::IfThenElse(condition.part[p], a.part[p], b.part[p]));
}

#define RELIEF_WIDE_UNARY(name, function)                                                                    \
    RELIEF_INLINE Float name(const Float& a) { RELIEF_RETURN_PARTS(Float, hn::function(a.part[p])); }
RELIEF_WIDE_UNARY(operator-, Neg)
RELIEF_WIDE_UNARY(abs, Abs)
RELIEF_WIDE_UNARY(sqrt, Sqrt)
#undef RELIEF_WIDE_UNARY

RELIEF_INLINE Float copy_sign(const Float& size, const Float& sign) {
    RELIEF_RETURN_PARTS(Float, hn::CopySign(size.part[p], sign.part[p]));
}

// As in scalar.h: the first operand where neither is less, NaN included.
RELIEF_INLINE Float min(const Float& a, const Float& b) { return select(b < a, b, a); }
RELIEF_INLINE Float max(const Float& a, const Float& b) { return select(a < b, b, a); }
RELIEF_INLINE Float clamp(const Float& a, const Float& low, const Float& high) {
    return min(max(a, low), high);
}

/// One 32-bit unsigned integer per lane; arithmetic wraps.
struct Uint {
    using D = hn::RebindToUnsigned<Float::D>;
    hn::Vec<D> part[Float::kParts];

    Uint() = default;
    RELIEF_INLINE Uint(uint32_t value) {
        for (auto& p : part) p = hn::Set(D(), value);
    }
    static RELIEF_INLINE Uint load(const uint32_t* aligned) {
        RELIEF_RETURN_PARTS(Uint, hn::Load(D(), aligned + p * Float::kLanes));
    }
    RELIEF_INLINE void store(uint32_t* aligned) const {
        for (size_t p = 0; p < Float::kParts; ++p) hn::Store(part[p], D(), aligned + p * Float::kLanes);
    }
    /// Truncates values in [0, 2^31); undefined for others.
    RELIEF_INLINE explicit Uint(const Float& value) {
        for (size_t p = 0; p < Float::kParts; ++p)
            part[p] = hn::BitCast(D(), hn::ConvertTo(hn::RebindToSigned<D>(), value.part[p]));
    }
    RELIEF_INLINE bool is_zero() const {
        bool all = true;
        for (const auto& p : part) all = all && hn::AllTrue(D(), hn::Eq(p, hn::Zero(D())));
        return all;
    }
    /// For values below 2^31.
    RELIEF_INLINE explicit operator Float() const {
        RELIEF_RETURN_PARTS(Float, hn::ConvertTo(Float::D(), hn::BitCast(hn::RebindToSigned<D>(), part[p])));
    }
};
using uint = Uint;

#define RELIEF_WIDE_UINT(name, assignment, function)                                                         \
    RELIEF_INLINE Uint name(const Uint& a, const Uint& b) {                                                  \
        RELIEF_RETURN_PARTS(Uint, hn::function(a.part[p], b.part[p]));                                       \
    }                                                                                                        \
    RELIEF_INLINE Uint& assignment(Uint& a, const Uint& b) { return a = name(a, b); }
RELIEF_WIDE_UINT(operator+, operator+=, Add)
RELIEF_WIDE_UINT(operator-, operator-=, Sub)
RELIEF_WIDE_UINT(operator*, operator*=, Mul)
RELIEF_WIDE_UINT(operator^, operator^=, Xor)
RELIEF_WIDE_UINT(operator&, operator&=, And)
RELIEF_WIDE_UINT(operator|, operator|=, Or)
#undef RELIEF_WIDE_UINT

RELIEF_INLINE Uint operator<<(const Uint& a, uint32_t count) {
    RELIEF_RETURN_PARTS(Uint, hn::ShiftLeftSame(a.part[p], int(count)));
}
RELIEF_INLINE Uint operator>>(const Uint& a, uint32_t count) {
    RELIEF_RETURN_PARTS(Uint, hn::ShiftRightSame(a.part[p], int(count)));
}

RELIEF_INLINE Uint min(const Uint& a, const Uint& b) {
    RELIEF_RETURN_PARTS(Uint, hn::Min(a.part[p], b.part[p]));
}
RELIEF_INLINE Uint select(const Bool& condition, const Uint& a, const Uint& b) {
    RELIEF_RETURN_PARTS(Uint,
                        hn::IfThenElse(hn::RebindMask(Uint::D(), condition.part[p]), a.part[p], b.part[p]));
}

/// Gathers base[index] in every lane; indices below 2^31.
RELIEF_INLINE Float gather(const float* base, const Uint& index) {
    RELIEF_RETURN_PARTS(
        Float, hn::GatherIndex(Float::D(), base, hn::BitCast(hn::RebindToSigned<Uint::D>(), index.part[p])));
}
RELIEF_INLINE Uint gather(const uint32_t* base, const Uint& index) {
    RELIEF_RETURN_PARTS(
        Uint, hn::GatherIndex(Uint::D(), base, hn::BitCast(hn::RebindToSigned<Uint::D>(), index.part[p])));
}

struct Vec2 {
    Float x, y;
};

struct Vec3 {
    Float x, y, z;
};

RELIEF_INLINE Vec2 select(const Bool& condition, const Vec2& a, const Vec2& b) {
    return {select(condition, a.x, b.x), select(condition, a.y, b.y)};
}
RELIEF_INLINE Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
RELIEF_INLINE Vec2 operator*(const Vec2& a, const Float& s) { return {a.x * s, a.y * s}; }
RELIEF_INLINE Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
RELIEF_INLINE Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
RELIEF_INLINE Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
RELIEF_INLINE Vec3 operator*(const Vec3& a, const Float& s) { return {a.x * s, a.y * s, a.z * s}; }
RELIEF_INLINE Vec3 operator/(const Vec3& a, const Float& s) { return {a.x / s, a.y / s, a.z / s}; }
RELIEF_INLINE Bool operator==(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
RELIEF_INLINE Float dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
RELIEF_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
RELIEF_INLINE Float length(const Vec3& a) { return sqrt(dot(a, a)); }
RELIEF_INLINE Vec3 select(const Bool& condition, const Vec3& a, const Vec3& b) {
    return {select(condition, a.x, b.x), select(condition, a.y, b.y), select(condition, a.z, b.z)};
}

/// normalize of math/vec.h, lane by lane, for the lanes in `which`.
RELIEF_INLINE void normalize_extreme(const Vec3& a, LaneMask which, Vec3& unit) {
    alignas(64) float in[3][16], out[3][16];
    a.x.store(in[0]), a.y.store(in[1]), a.z.store(in[2]);
    unit.x.store(out[0]), unit.y.store(out[1]), unit.z.store(out[2]);
    for (; which != 0; which &= which - 1) {
        const int lane = int(hwy::Num0BitsBelowLS1Bit_Nonzero32(which));
        const Vec3f fixed = normalize(Vec3f{in[0][lane], in[1][lane], in[2][lane]});
        out[0][lane] = fixed.x, out[1][lane] = fixed.y, out[2][lane] = fixed.z;
    }
    unit = {Float::load(out[0]), Float::load(out[1]), Float::load(out[2])};
}

/// Unit vectors; (0, 0, 0) for a zero or non-finite vector.
RELIEF_INLINE Vec3 make_unit(const Vec3& a) {
    const Float squared = dot(a, a);
    Vec3 unit = a / sqrt(squared);
    const LaneMask usual =
        to_mask(squared > Float(1e-37f) && squared <= Float(std::numeric_limits<float>::max()));
    if (usual != 0xffffu) normalize_extreme(a, ~usual & 0xffffu, unit);
    return unit;
}

RELIEF_INLINE Vec3 normalize(const Vec3& a) { return make_unit(a); }

using scalar::kPi;
#define RELIEF_LANES
#include "formulas/basis.h"
#include "formulas/cross.h"
#include "formulas/octahedron.h"
#include "formulas/picture_plane.h"
#include "formulas/shading_normal.h"
#include "formulas/sobol.h"
#include "formulas/surface_point.h"
#include "formulas/trig.h"
#include "formulas/warp.h"
#undef RELIEF_LANES

} // namespace relief::HWY_NAMESPACE::wide
HWY_AFTER_NAMESPACE();

#endif
