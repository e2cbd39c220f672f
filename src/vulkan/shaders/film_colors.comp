// The colours of the film's sums by themselves, a word an invocation: what most pictures need of them.
#include "vulkan/shaders/kernel.glsl"
#include "vulkan/layout/device_paths.h"

layout(scalar, push_constant) uniform Push { FilmColorsPush push; };
layout(scalar, set = 0, binding = kBindFilm) readonly buffer FilmWords { uint film_words[]; };
layout(scalar, set = 0, binding = kBindPoints) writeonly buffer ColorWords { uint color_words[]; };

void main() {
    uint index = invocation_index();
    if (index >= push.word_count) return;
    color_words[index] = film_words[index / kFilmColorsWords * kFilmSumsWords + index % kFilmColorsWords];
}
