#include "io/picture/module/colour_transform_ocio.h"

#include <OpenColorIO/OpenColorIO.h>

#include "relief/error.h"

namespace relief {

namespace {

namespace ocio = OCIO_NAMESPACE;

ocio::TransformRcPtr make_builtin(const char* style,
                                  ocio::TransformDirection direction = ocio::TRANSFORM_DIR_FORWARD) {
    const ocio::BuiltinTransformRcPtr transform = ocio::BuiltinTransform::Create();
    transform->setStyle(style);
    transform->setDirection(direction);
    return transform;
}

class OcioTransform final : public ColourTransform {
  public:
    explicit OcioTransform(const ocio::ConstTransformRcPtr& transform)
        : processor_(ocio::Config::CreateRaw()->getProcessor(transform)->getDefaultCPUProcessor()) {}

    Vec3f apply(const Vec3f& colour) const override {
        float rgb[3] = {colour.x, colour.y, colour.z};
        processor_->applyRGB(rgb);
        return {rgb[0], rgb[1], rgb[2]};
    }

  private:
    ocio::ConstCPUProcessorRcPtr processor_;
};

} // namespace

std::unique_ptr<ColourTransform> make_ocio_aces_display() {
    try {
        const ocio::GroupTransformRcPtr all = ocio::GroupTransform::Create();
        all->appendTransform(
            make_builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_INVERSE));
        all->appendTransform(make_builtin("ACEScg_to_ACES2065-1"));
        all->appendTransform(make_builtin("ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0"));
        all->appendTransform(make_builtin("DISPLAY - CIE-XYZ-D65_to_sRGB"));
        return std::make_unique<OcioTransform>(all);
    } catch (const ocio::Exception& error) {
        throw Error(ErrorKind::failed, {"ACES cannot be shown", error.what(), "choose --tonemap agx"});
    }
}

} // namespace relief
