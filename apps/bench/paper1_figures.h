// Figures of the paper: its table, and statements in its text about plots without numbers.
#pragma once

#include <array>
#include <string_view>

#include "bench/paper_statement.h"

namespace relief::bench {

/// Table 1.1: memory of geometry and acceleration structure, bytes; decimal, as printed.
struct PaperMemory {
    std::string_view scene;
    double tessellated_bytes, direct_bytes;
};

inline constexpr std::array<PaperMemory, 4> kPaperMemory = {
    {{"party", 52e9, 16e6}, {"bark", 1.7e9, 0.47e6}, {"barks", 12e9, 3.3e6}, {"pumpkin", 380e6, 0.12e6}}};

inline constexpr double kPaperPartyFrameMilliseconds = 77;

/// By figure.
inline constexpr std::array<PaperStatement, 7> kPaperStatements = {
    {{"figure1_1", "Party renders in 77 ms a frame on an AMD FirePro W9100"},
     {"figure1_7", "pre-tessellation is faster only for Pumpkin, and slower for Bark"},
     {"figure1_7", "Barks and Party cannot be rendered pre-tessellated: they do not fit the device"},
     {"figure1_9", "most of the time goes to building and casting against patch trees"},
     {"figure1_9", "sorting takes time roughly proportional to the number of pairs"},
     {"figure1_9", "for Barks shadow rays take about as long as primary rays, though there are fewer"},
     {"figure1_10", "the time of a cast does not fall much with depth, though fewer rays are left"}}};

inline constexpr std::array<std::string_view, 7> kComparable = {
    "The sample scenes have the names and about the patch counts of the paper's, but are other models.",
    "The paper's device is an AMD FirePro W9100, 5.2 TFLOP/s; times compare as ratios, not as milliseconds.",
    "The paper's frame casts one primary and one shadow ray a pixel under an environment; so does ours.",
    "The paper keeps no patch tree between casts: compare it with the runs without the cache. The GPU "
    "engine then builds each tree once a cast as the paper does; the CPU engine builds it for every packet "
    "of "
    "rays that meets the patch, which costs more.",
    "Figure 1.10 renders Bark in white, so that roulette ends no path and rays are left at every depth.",
    "Every run starts with an empty cache: what it saves is what the casts of one frame share.",
    "The paper's figures 1.7, 1.9 and 1.10 print no numbers, so that its statements about them stand here."};

} // namespace relief::bench
