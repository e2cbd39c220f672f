// A stream of ours as OpenEXR wants it.
#pragma once

#include <cstdint>
#include <istream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include <OpenEXR/ImfIO.h>

namespace relief {

class ExrInputStream final : public Imf::IStream {
  public:
    ExrInputStream(std::unique_ptr<std::istream> stream, const std::string& name)
        : IStream(name.c_str()), stream_(std::move(stream)) {}

    bool read(char bytes[], int count) override {
        if (!stream_->read(bytes, count))
            throw std::runtime_error(stream_->eof() ? "unexpected end of file" : "the file cannot be read");
        return stream_->peek() != std::istream::traits_type::eof();
    }
    uint64_t tellg() override { return uint64_t(std::streamoff(stream_->tellg())); }
    void seekg(uint64_t position) override {
        stream_->clear();
        stream_->seekg(std::streamoff(position));
    }
    void clear() override { stream_->clear(); }

  private:
    std::unique_ptr<std::istream> stream_;
};

} // namespace relief
