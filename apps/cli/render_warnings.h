// Warnings of a render: each is printed once, before the first ray, in the words of the command or the scene
// file.
#pragma once

#include <string>
#include <vector>

#include "common/progress.h"
#include "relief/scene.h"
#include "render_options.h"
#include "wait_notice.h"

namespace relief::cli {

/// Adds to a scene's warnings what speaks against assumptions about its maps, and prints what speaks against
/// what was declared, which is no warning: who declared it may know better.
void add_assumption_warnings(Scene& scene, const RenderOptions& options);

/// "displacement.axes = t,n,b" as the user writes it: an option with a mesh, a key in a scene file.
std::string name_setting(std::string warning, bool is_mesh);

/// Prints progress and warnings; an interrupt, and under --strict a warning, cancels the render.
class RenderWatcher final : public RenderObserver {
  public:
    /// `told`: warnings printed before, by other pictures of the same scene; outlives this object. `step`:
    /// which of several pictures this is; empty: the only one.
    RenderWatcher(const RenderOptions& options, size_t& told, std::string step = {});

    void on_warnings(const std::vector<std::string>& warnings) override;
    void on_progress(const Progress& progress) override;
    bool is_cancelled() const override;

    /// Whether --strict stood in the way of the picture.
    bool is_refused() const { return is_refused_; }

  private:
    ProgressPrinter printer_;
    const RenderOptions& options_;
    size_t& told_;
    std::string step_;
    bool is_refused_ = false;
    WaitNotice preparing_;
};

} // namespace relief::cli
