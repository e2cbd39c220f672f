// Warnings of a render: each is printed once, before the first ray, in the words of the command or the scene
// file.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/progress.h"
#include "relief/scene.h"
#include "render_options.h"
#include "wait_notice.h"

namespace relief::cli {

/// Adds doubts about assumed conventions of maps to the warnings of a scene, and prints doubts about declared
/// ones as notes, unless `is_quiet`. `is_mesh`: as for name_setting.
void add_assumption_warnings(Scene& scene, bool is_quiet, bool is_mesh);

/// "displacement.axes = t,n,b" as the user writes it: an option with a mesh, a key in a scene file. Settings
/// of the render are options with both.
std::string name_setting(std::string warning, bool is_mesh);

/// In lines of their own, with settings in the words of `name_setting`.
void print_warnings(const std::vector<std::string>& warnings, bool is_mesh);

/// Which warnings were told, by all pictures of a command.
class ToldWarnings {
  public:
    /// Those that were not told yet; from now on they are.
    std::vector<std::string> take_new(const std::vector<std::string>& warnings);

  private:
    std::set<std::string> told_;
};

/// Prints progress and warnings; an interrupt, and under --strict a warning, cancels the render.
class RenderWatcher final : public RenderObserver {
  public:
    /// `told` outlives this object. `step`: which of several pictures this is; empty: the only one.
    RenderWatcher(const RenderOptions& options, ToldWarnings& told, std::string step = {});

    void on_warnings(const std::vector<std::string>& warnings) override;
    void on_progress(const Progress& progress) override;
    bool is_cancelled() const override;

    /// Whether --strict stood in the way of the picture.
    bool is_refused() const { return is_refused_; }

  private:
    ProgressPrinter printer_;
    const RenderOptions& options_;
    ToldWarnings& told_;
    std::string step_;
    bool is_refused_ = false;
    WaitNotice preparing_;
};

} // namespace relief::cli
