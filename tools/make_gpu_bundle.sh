#!/bin/sh
# Packs the tests and measurements of the Vulkan engine, with all that they need but glibc and a driver, into one
# folder that runs on a bare machine.
#   make_gpu_bundle.sh BUILD_FOLDER BUNDLE_FOLDER
set -eu

build=$1
bundle=$2
limit_mebibytes=60

# What the machine has anyway, or must not have twice.
is_of_the_system() {
    case $(basename "$1") in
    ld-linux* | libc.so* | libm.so* | libdl.so* | libpthread.so* | librt.so* | libresolv.so*) return 0 ;;
    esac
    return 1
}

# Used only where the machine has none: its driver wants its own.
is_fallback() {
    case $(basename "$1") in
    libstdc++.so* | libgcc_s.so*) return 0 ;;
    esac
    return 1
}

# copy_closure FILE FOLDER: the libraries that FILE needs.
copy_closure() {
    ldd "$1" | sed -n 's/.* => \(\/[^ ]*\) .*/\1/p' | while read -r library; do
        if is_of_the_system "$library"; then continue; fi
        if is_fallback "$library"; then cp -L "$library" "$bundle/fallback/"; else cp -L "$library" "$2/"; fi
    done
}

# find_library NAME: its file, as the dynamic linker would find it.
find_library() {
    PATH=$PATH:/sbin ldconfig -p | sed -n "s|^[[:space:]]*$1 (.*x86-64.*) => ||p; s|^[[:space:]]*$1 (.*AArch64.*) => ||p" |
        head -n 1
}

rm -rf "$bundle"
mkdir -p "$bundle/lib" "$bundle/fallback" "$bundle/layers"
# Programs are packed: each holds the kernels of all instruction sets and all shaders.
for program in relief-gpu vulkan_tests; do
    cp "$build/bin/$program" "$bundle/"
    strip "$bundle/$program"
    copy_closure "$bundle/$program" "$bundle/lib"
    gzip -9 -n "$bundle/$program"
done

# The loader, and what drivers want beside it, for machines that have a driver alone.
loader=$(find_library libvulkan.so.1)
[ -n "$loader" ] || { echo "make_gpu_bundle.sh: there is no libvulkan.so.1 (package libvulkan1)" >&2 && exit 1; }
cp -L "$loader" "$bundle/fallback/"
for name in libX11.so.6 libXext.so.6 libxcb.so.1 libXau.so.6 libXdmcp.so.6 libbsd.so.0 libmd.so.0; do
    library=$(find_library $name)
    [ -z "$library" ] || cp -L "$library" "$bundle/fallback/"
done
# All of libglvnd: newer drivers of NVIDIA load libEGL.so.1 while they answer the Vulkan loader, which otherwise finds no
# device, and libEGL.so.1 comes with its siblings.
for pair in libEGL.so.1:libegl1 libGLX.so.0:libglx0 libGL.so.1:libgl1 libOpenGL.so.0:libopengl0 libGLESv2.so.2:libgles2 \
    libGLdispatch.so.0:libglvnd0; do
    library=$(find_library "${pair%:*}")
    [ -n "$library" ] || { echo "make_gpu_bundle.sh: there is no ${pair%:*} (package ${pair#*:})" >&2 && exit 1; }
    cp -L "$library" "$bundle/fallback/"
done

# Validation: the tests fail without it.
manifest=/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json
layer=$(find_library libVkLayer_khronos_validation.so)
[ -n "$layer" ] && [ -f $manifest ] ||
    { echo "make_gpu_bundle.sh: the validation layer is missing (package vulkan-validationlayers)" >&2 && exit 1; }
cp -L "$layer" "$bundle/layers/"
sed 's|"library_path": *"[^"]*"|"library_path": "./libVkLayer_khronos_validation.so"|' $manifest \
    >"$bundle/layers/VkLayer_khronos_validation.json"
copy_closure "$layer" "$bundle/lib"

cp "$(dirname "$0")/../apps/gpu/run.sh" "$bundle/run.sh"
git -C "$(dirname "$0")" describe --always --dirty --abbrev=10 >"$bundle/commit" 2>/dev/null || echo unknown >"$bundle/commit"

mebibytes=$(du -sm "$bundle" | cut -f 1)
if [ "$mebibytes" -ge $limit_mebibytes ]; then
    echo "make_gpu_bundle.sh: $bundle has $mebibytes MiB, less than $limit_mebibytes are allowed" >&2
    exit 1
fi
echo "$bundle: $mebibytes MiB; carry it to a machine with a Vulkan driver and start run.sh there"
