// The viewer without a window, for browsers.
#pragma once

#include "viewer/viewer_options.h"

namespace relief::viewer {

/// Shows the scene to browsers until SIGINT or SIGTERM; prints the address. Returns the exit code. Throws as
/// BrowserServer.
int serve(const ViewerOptions& options);

} // namespace relief::viewer
