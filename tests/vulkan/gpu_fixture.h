// One validated device for all tests of the process; a message of the validation layer fails the test that
// caused it.
#pragma once

#include <cstdlib>

#include <gtest/gtest.h>

#include "vulkan/device/device.h"

namespace relief::vulkan::tests {

/// Of the device under test: RELIEF_TEST_DEVICE, or the best one.
inline int get_test_device_index() {
    const char* index = std::getenv("RELIEF_TEST_DEVICE");
    return index ? std::atoi(index) : -1;
}

/// Created on first use, with Khronos validation and synchronisation validation.
inline const Device& get_test_device() {
    static const Device device({.index = get_test_device_index(), .is_validated = true});
    return device;
}

class GpuTest : public testing::Test {
  protected:
    void TearDown() override {
        const std::vector<std::string> messages = device().validation_messages();
        for (; told_count_ < messages.size(); ++told_count_) ADD_FAILURE() << messages[told_count_];
    }

    static const Device& device() { return get_test_device(); }

  private:
    static inline size_t told_count_ = 0; ///< messages already reported as test failures
};

} // namespace relief::vulkan::tests
