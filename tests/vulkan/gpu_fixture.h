// One validated device for all tests of the process; a message of the validation layer fails the test that
// caused it.
#pragma once

#include <gtest/gtest.h>

#include "engine/vulkan/device.h"

namespace relief::vulkan::tests {

/// Made when first asked for: with Khronos validation and synchronisation validation.
inline const Device& get_test_device() {
    static const Device device({.is_validated = true});
    return device;
}

class GpuTest : public testing::Test {
  protected:
    GpuTest() : first_message_(get_test_device().validation_messages().size()) {}

    void TearDown() override {
        const std::vector<std::string> messages = device().validation_messages();
        for (size_t i = first_message_; i < messages.size(); ++i) ADD_FAILURE() << messages[i];
    }

    static const Device& device() { return get_test_device(); }

  private:
    size_t first_message_;
};

} // namespace relief::vulkan::tests
