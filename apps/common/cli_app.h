// Forward declaration of CLI11's App, whose header is slow to compile.
#pragma once

namespace CLI {
class App;
class Option;
} // namespace CLI
