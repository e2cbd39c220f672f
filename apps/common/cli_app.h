// CLI11's App by name alone: its header takes a compiler longer to read than any of ours.
#pragma once

namespace CLI {
class App;
}
