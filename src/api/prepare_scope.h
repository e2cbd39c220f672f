// How an observer of a render follows the work before the first ray.
#pragma once

#include <optional>

#include "base/stop_request.h"
#include "relief/render.h"

namespace relief {

/// While it lives, preparation tells the observer how far it is, and throws StopRequest once that cancels.
class PrepareScope {
  public:
    /// `observer` may be null: nobody asks.
    explicit PrepareScope(RenderObserver* observer) {
        if (observer)
            scope_.emplace([observer] { return observer->is_cancelled(); },
                           [observer](double fraction) { observer->on_preparation(fraction); });
    }

  private:
    std::optional<StopScope> scope_;
};

} // namespace relief
