// A surface of which a part is glass is at each vertex of a path the glass or the opaque rest, at random.
// Clear walls are met or passed at random before that, so that rays from and to a vertex go through them.
#ifndef RELIEF_GLASS_VERTEX_H
#define RELIEF_GLASS_VERTEX_H
#include "formulas/bsdf.h"
#include "formulas/glass.h"

#include "formulas/begin.h"

struct GlassDraw {
    Bool is_glass;
    Float metallic; ///< of the opaque rest
    Float u;        ///< a random number in [0, 1) again
    Vec3 weight;    ///< of the path
};

FN Float largest_component(const Vec3 color) { return max(max(color.x, color.y), color.z); }

/// What of the light passes a clear wall of that opacity straight on. `cosine`: of the ray to the geometric
/// normal, for whoever meets the wall finds its own share by it too.
FN Vec3 pass_clear_wall(const GlassParameters g, const Float metallic, const Float opacity,
                        const Float cosine) {
    Float share = opacity * g.weight * (1.0f - metallic);
    return make_grey(1.0f - opacity) + meet_wall(g, cosine).passed * share;
}

/// `u` in [0, 1) draws. Probabilities are by what each of the two reflects, given that a clear wall was not
/// passed, which its largest component of pass_clear_wall at opacity 1 decides.
FN GlassDraw draw_glass(const GlassParameters g, const Float metallic, const Float cosine, const Float u) {
    Float share = g.weight * (1.0f - metallic);
    Float rest = 1.0f - share;
    GlassDraw drawn;
    Vec3 color = make_grey(1.0f);
    Float scale = 1.0f;
    Float glass = share;
    if (g.kind == kClearWall) {
        WallLight wall = meet_wall(g, cosine);
        Float reflected = luminance(wall.reflected);
        color = wall.reflected * (1.0f / reflected);
        glass = share * reflected;
        scale = (glass + rest) / max(1.0f - share * largest_component(wall.passed), 1e-9f);
    }
    Float bound = glass / max(glass + rest, 1e-9f);
    drawn.is_glass = u < bound;
    drawn.u = drawn.is_glass ? u / bound : (u - bound) / (1.0f - bound);
    drawn.u = min(drawn.u, 0.99999994f);
    drawn.metallic = min(metallic / max(rest, 1e-9f), 1.0f);
    drawn.weight = (drawn.is_glass ? color : make_grey(1.0f)) * min(scale, 1.0f);
    return drawn;
}

#include "formulas/end.h"
#endif
