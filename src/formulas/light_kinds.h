// Kinds of light by what it did at the first surface that the camera sees: layers of a picture that add up to
// its colour.
#ifndef RELIEF_LIGHT_KINDS_H
#define RELIEF_LIGHT_KINDS_H
#include "formulas/begin.h"

/// Ways in which the first surface scatters light; each has two kinds, direct and indirect.
const uint kLobeDiffuse = 0u;
const uint kLobeSpecular = 1u;
const uint kLobeTransmission = 2u;
const uint kLobeCount = 3u;

// In the order of kLightKinds (image/light_layers.h). A further way of scattering goes before these two.
const uint kKindEmission = 6u;   ///< surfaces and lights that the camera sees shine
const uint kKindBackground = 7u; ///< what the camera sees behind all surfaces
const uint kKindCount = 8u;

/// How light that a surface scatters is shared out over the lobes.
struct LightShares {
    Vec3 diffuse; ///< in [0, 1]
    uint rest;    ///< lobe of the rest: specular or transmission
};

/// Of light that the first surface scatters; `bounces`: what is between it and the light.
FN uint find_light_kind(const uint lobe, const uint bounces) { return 2u * lobe + (bounces > 0u ? 1u : 0u); }

#include "formulas/end.h"
#endif
