#include "io/picture/module/color_transform_ocio.h"

#include <cstdlib>

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

class OcioTransform final : public ColorTransform {
  public:
    explicit OcioTransform(const ocio::ConstTransformRcPtr& transform)
        : OcioTransform(ocio::Config::CreateRaw(), transform) {}
    OcioTransform(const ocio::ConstConfigRcPtr& config, const ocio::ConstTransformRcPtr& transform)
        : processor_(config->getProcessor(transform)->getDefaultCPUProcessor()) {}

    Vec3f apply(const Vec3f& color) const override {
        float rgb[3] = {color.x, color.y, color.z};
        processor_->applyRGB(rgb);
        return {rgb[0], rgb[1], rgb[2]};
    }

  private:
    ocio::ConstCPUProcessorRcPtr processor_;
};

void add_aces_to_rec709(ocio::GroupTransform& all) {
    all.appendTransform(make_builtin("ACEScg_to_ACES2065-1", ocio::TRANSFORM_DIR_INVERSE));
    all.appendTransform(make_builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD"));
}

/// Of the configuration that OCIO names; nothing where there is none or it lacks the space.
ocio::ConstConfigRcPtr find_config(const std::string& space) {
    const char* const named = std::getenv(ocio::OCIO_CONFIG_ENVVAR);
    if (!named || !*named) return nullptr;
    const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromEnv();
    if (!config->getColorSpace(space.c_str())) return nullptr;
    if (!config->hasRole(ocio::ROLE_INTERCHANGE_SCENE))
        throw ocio::Exception("the configuration has no role aces_interchange");
    return config;
}

/// From the space to ACES2065-1; nothing where it is not known.
ocio::TransformRcPtr find_to_aces(const std::string& name, const ocio::ConstConfigRcPtr& config) {
    if (name == "acescg") return make_builtin("ACEScg_to_ACES2065-1");
    if (name == "acescct") return make_builtin("ACEScct_to_ACES2065-1");
    if (name == "aces2065-1") return ocio::GroupTransform::Create();
    if (!config) return nullptr;
    const ocio::ColorSpaceTransformRcPtr transform = ocio::ColorSpaceTransform::Create();
    transform->setSrc(name.c_str());
    transform->setDst(ocio::ROLE_INTERCHANGE_SCENE);
    return transform;
}

} // namespace

std::unique_ptr<ColorTransform> make_ocio_color_space(const std::string& name, ColorWay way) {
    try {
        const ocio::ConstConfigRcPtr config = find_config(name);
        const ocio::TransformRcPtr to_aces = find_to_aces(name, config);
        if (!to_aces) return nullptr;
        const ocio::GroupTransformRcPtr all = ocio::GroupTransform::Create();
        all->appendTransform(to_aces);
        add_aces_to_rec709(*all);
        if (way == ColorWay::to_file) all->setDirection(ocio::TRANSFORM_DIR_INVERSE);
        return std::make_unique<OcioTransform>(config ? config : ocio::Config::CreateRaw(), all);
    } catch (const ocio::Exception& error) {
        throw Error(ErrorKind::bad_input,
                    {"no colours can be taken from '" + name + "'", error.what(),
                     "mend the configuration that the environment variable OCIO names"});
    }
}

std::unique_ptr<ColorTransform> make_ocio_aces_display() {
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
