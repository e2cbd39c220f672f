// Directional albedo of the GGX microfacet lobe (height-correlated Smith, no energy compensation), tabulated.
#ifndef RELIEF_GGX_ALBEDO_H
#ifndef __cplusplus
#define RELIEF_GGX_ALBEDO_H
#endif

// Split by Fresnel as in Karis 2013, Real Shading in Unreal Engine 4: albedo = f0 scale + f90 bias, with
// Schlick's Fresnel. Rows: roughness 0, 1/15, ..., 1. Columns: square root of the cosine 0, 1/15, ..., 1.
// From 400 x 400 stratified samples an entry; the tests compute the integrals anew and compare. The averages
// are 2 integral(albedo(x) x dx) of the linearly interpolated table, not of the lobe itself, so that what the
// table says adds up to one exactly.
#ifdef __cplusplus
// clang-format off
const float kGgxScale[256] = {
    0.02569f, 0.02558f, 0.08667f, 0.18498f, 0.30862f, 0.44515f, 0.58182f, 0.70716f, 0.81241f, 0.89262f, 0.94707f, 0.97890f, 0.99395f, 0.99904f, 0.99996f, 1.00000f,
    0.08801f, 0.06386f, 0.09870f, 0.19027f, 0.31117f, 0.44637f, 0.58232f, 0.70737f, 0.81243f, 0.89258f, 0.94702f, 0.97886f, 0.99393f, 0.99904f, 0.99996f, 1.00000f,
    0.23714f, 0.21666f, 0.19500f, 0.23660f, 0.33398f, 0.45769f, 0.58736f, 0.70882f, 0.81210f, 0.89152f, 0.94592f, 0.97792f, 0.99337f, 0.99890f, 0.99993f, 1.00000f,
    0.38788f, 0.37566f, 0.35029f, 0.34750f, 0.39503f, 0.48635f, 0.59845f, 0.71072f, 0.80950f, 0.88723f, 0.94154f, 0.97435f, 0.99063f, 0.99668f, 0.99810f, 0.99748f,
    0.52067f, 0.51306f, 0.49406f, 0.47980f, 0.49128f, 0.53955f, 0.61834f, 0.71080f, 0.80001f, 0.87447f, 0.92904f, 0.96378f, 0.98244f, 0.99051f, 0.99320f, 0.99461f,
    0.62966f, 0.62413f, 0.61002f, 0.59594f, 0.59217f, 0.61011f, 0.65340f, 0.71629f, 0.78681f, 0.85277f, 0.90590f, 0.94298f, 0.96536f, 0.97700f, 0.98240f, 0.98542f,
    0.71526f, 0.71027f, 0.69851f, 0.68512f, 0.67583f, 0.67748f, 0.69540f, 0.73015f, 0.77694f, 0.82752f, 0.87384f, 0.91060f, 0.93630f, 0.95230f, 0.96177f, 0.96775f,
    0.78062f, 0.77513f, 0.76335f, 0.74959f, 0.73707f, 0.73013f, 0.73240f, 0.74619f, 0.77083f, 0.80284f, 0.83707f, 0.86867f, 0.89444f, 0.91365f, 0.92728f, 0.93717f,
    0.82962f, 0.82291f, 0.81000f, 0.79411f, 0.77837f, 0.76543f, 0.75772f, 0.75719f, 0.76475f, 0.77952f, 0.79931f, 0.82115f, 0.84232f, 0.86106f, 0.87681f, 0.88993f,
    0.86593f, 0.85806f, 0.84230f, 0.82326f, 0.80351f, 0.78521f, 0.76997f, 0.75930f, 0.75414f, 0.75482f, 0.76078f, 0.77082f, 0.78341f, 0.79714f, 0.81101f, 0.82449f,
    0.89271f, 0.88331f, 0.86413f, 0.84078f, 0.81627f, 0.79233f, 0.77040f, 0.75155f, 0.73658f, 0.72601f, 0.72000f, 0.71832f, 0.72044f, 0.72568f, 0.73337f, 0.74292f,
    0.91242f, 0.90117f, 0.87793f, 0.84974f, 0.81963f, 0.78967f, 0.76111f, 0.73487f, 0.71161f, 0.69179f, 0.67570f, 0.66346f, 0.65504f, 0.65029f, 0.64894f, 0.65071f,
    0.92696f, 0.91357f, 0.88589f, 0.85219f, 0.81601f, 0.77957f, 0.74423f, 0.71089f, 0.68013f, 0.65231f, 0.62767f, 0.60637f, 0.58848f, 0.57401f, 0.56292f, 0.55512f,
    0.93773f, 0.92193f, 0.88955f, 0.84987f, 0.80717f, 0.76393f, 0.72169f, 0.68140f, 0.64363f, 0.60869f, 0.57675f, 0.54789f, 0.52213f, 0.49943f, 0.47975f, 0.46302f,
    0.94575f, 0.92736f, 0.88995f, 0.84399f, 0.79448f, 0.74426f, 0.69511f, 0.64806f, 0.60375f, 0.56248f, 0.52438f, 0.48944f, 0.45759f, 0.42873f, 0.40270f, 0.37937f,
    0.95176f, 0.93084f, 0.88794f, 0.83543f, 0.77894f, 0.72172f, 0.66578f, 0.61233f, 0.56205f, 0.51528f, 0.47213f, 0.43256f, 0.39644f, 0.36359f, 0.33379f, 0.30682f
};
const float kGgxBias[256] = {
    0.95395f, 0.94493f, 0.91156f, 0.81477f, 0.69133f, 0.55483f, 0.41817f, 0.29284f, 0.18759f, 0.10737f, 0.05292f, 0.02110f, 0.00605f, 0.00096f, 0.00004f, 0.00000f,
    0.90727f, 0.82821f, 0.86584f, 0.80245f, 0.68663f, 0.55279f, 0.41723f, 0.29253f, 0.18751f, 0.10739f, 0.05296f, 0.02113f, 0.00606f, 0.00096f, 0.00004f, 0.00000f,
    0.76168f, 0.73589f, 0.69699f, 0.68553f, 0.63050f, 0.52691f, 0.40535f, 0.28735f, 0.18571f, 0.10711f, 0.05324f, 0.02144f, 0.00626f, 0.00104f, 0.00005f, 0.00000f,
    0.61159f, 0.60158f, 0.57418f, 0.54373f, 0.51015f, 0.45165f, 0.36558f, 0.26871f, 0.17833f, 0.10519f, 0.05346f, 0.02216f, 0.00675f, 0.00122f, 0.00008f, 0.00000f,
    0.47901f, 0.47325f, 0.45576f, 0.42906f, 0.39647f, 0.35524f, 0.29957f, 0.23142f, 0.16093f, 0.09905f, 0.05254f, 0.02291f, 0.00753f, 0.00157f, 0.00015f, 0.00000f,
    0.37012f, 0.36589f, 0.35302f, 0.33228f, 0.30480f, 0.27145f, 0.23146f, 0.18468f, 0.13450f, 0.08729f, 0.04907f, 0.02292f, 0.00827f, 0.00202f, 0.00026f, 0.00001f,
    0.28454f, 0.28105f, 0.27074f, 0.25420f, 0.23212f, 0.20544f, 0.17491f, 0.14122f, 0.10589f, 0.07188f, 0.04287f, 0.02157f, 0.00859f, 0.00243f, 0.00039f, 0.00001f,
    0.21918f, 0.21614f, 0.20749f, 0.19394f, 0.17613f, 0.15494f, 0.13129f, 0.10615f, 0.08065f, 0.05638f, 0.03523f, 0.01894f, 0.00827f, 0.00266f, 0.00051f, 0.00002f,
    0.17017f, 0.16742f, 0.16002f, 0.14864f, 0.13406f, 0.11708f, 0.09858f, 0.07944f, 0.06060f, 0.04301f, 0.02774f, 0.01570f, 0.00740f, 0.00265f, 0.00059f, 0.00003f,
    0.13381f, 0.13131f, 0.12476f, 0.11503f, 0.10288f, 0.08908f, 0.07441f, 0.05960f, 0.04539f, 0.03242f, 0.02129f, 0.01248f, 0.00622f, 0.00243f, 0.00062f, 0.00004f,
    0.10699f, 0.10464f, 0.09872f, 0.09021f, 0.07990f, 0.06849f, 0.05665f, 0.04501f, 0.03409f, 0.02436f, 0.01614f, 0.00966f, 0.00502f, 0.00209f, 0.00059f, 0.00005f,
    0.08721f, 0.08495f, 0.07945f, 0.07187f, 0.06293f, 0.05332f, 0.04360f, 0.03429f, 0.02577f, 0.01833f, 0.01217f, 0.00738f, 0.00393f, 0.00172f, 0.00052f, 0.00005f,
    0.07260f, 0.07035f, 0.06514f, 0.05822f, 0.05033f, 0.04208f, 0.03397f, 0.02639f, 0.01963f, 0.01386f, 0.00918f, 0.00559f, 0.00303f, 0.00137f, 0.00044f, 0.00005f,
    0.06176f, 0.05946f, 0.05443f, 0.04799f, 0.04088f, 0.03367f, 0.02679f, 0.02053f, 0.01508f, 0.01054f, 0.00694f, 0.00422f, 0.00231f, 0.00107f, 0.00036f, 0.00004f,
    0.05365f, 0.05127f, 0.04633f, 0.04022f, 0.03371f, 0.02731f, 0.02138f, 0.01613f, 0.01169f, 0.00808f, 0.00527f, 0.00320f, 0.00175f, 0.00082f, 0.00029f, 0.00004f,
    0.04755f, 0.04508f, 0.04012f, 0.03424f, 0.02819f, 0.02244f, 0.01726f, 0.01281f, 0.00914f, 0.00623f, 0.00403f, 0.00243f, 0.00133f, 0.00063f, 0.00023f, 0.00003f
};
const float kGgxAverageScale[16] = {
    0.95164f, 0.95169f, 0.95187f, 0.95055f, 0.94550f, 0.93384f, 0.91353f, 0.88286f, 0.84153f, 0.79032f, 0.73102f, 0.66618f, 0.59868f, 0.53140f, 0.46679f, 0.40664f
};
const float kGgxAverageBias[16] = {
    0.04835f, 0.04821f, 0.04693f, 0.04371f, 0.03875f, 0.03283f, 0.02682f, 0.02133f, 0.01666f, 0.01287f, 0.00989f, 0.00760f, 0.00586f, 0.00454f, 0.00354f, 0.00279f
};
// clang-format on
#else
// Shaders read the same numbers from memory: compilers for devices copy a constant array to each place that
// indexes it, which costs some of them minutes. Kernels find the table bound
// (engine/vulkan/binding_table.cpp).
#include "shared/bindings.h"
layout(binding = kBindAlbedos) uniform samplerBuffer ggx_albedo_table;
#endif

/// Albedo = f0 * scale + f90 * bias.
struct GgxAlbedo {
    float scale, bias;
};

const uint kGgxAverages = 256u; ///< where the averages follow in the table
const uint kGgxEntryCount = 272u;

/// Entry of the table.
FN GgxAlbedo read_ggx_albedo(uint i) {
#ifdef __cplusplus
    GgxAlbedo result = {i < kGgxAverages ? kGgxScale[i] : kGgxAverageScale[i - kGgxAverages],
                        i < kGgxAverages ? kGgxBias[i] : kGgxAverageBias[i - kGgxAverages]};
#else
    vec4 texel = texelFetch(ggx_albedo_table, int(i));
    GgxAlbedo result = {texel.x, texel.y};
#endif
    return result;
}

FN GgxAlbedo mix_ggx_albedo(GgxAlbedo a, GgxAlbedo b, float f) {
    GgxAlbedo result = {mix(a.scale, b.scale, f), mix(a.bias, b.bias, f)};
    return result;
}

FN GgxAlbedo lookup_ggx_albedo(float roughness, float cos_theta) {
    float y = clamp(roughness, 0.0f, 1.0f) * 15.0f;
    float x = sqrt(clamp(cos_theta, 0.0f, 1.0f)) * 15.0f;
    float row = min(floor(y), 14.0f);
    float column = min(floor(x), 14.0f);
    float fx = x - column;
    uint i = uint(row) * 16u + uint(column);
    GgxAlbedo above = mix_ggx_albedo(read_ggx_albedo(i), read_ggx_albedo(i + 1u), fx);
    GgxAlbedo below = mix_ggx_albedo(read_ggx_albedo(i + 16u), read_ggx_albedo(i + 17u), fx);
    return mix_ggx_albedo(above, below, y - row);
}

/// Cosine-weighted mean over the hemisphere.
FN GgxAlbedo lookup_ggx_average(float roughness) {
    float y = clamp(roughness, 0.0f, 1.0f) * 15.0f;
    float row = min(floor(y), 14.0f);
    uint i = kGgxAverages + uint(row);
    return mix_ggx_albedo(read_ggx_albedo(i), read_ggx_albedo(i + 1u), y - row);
}

#endif
