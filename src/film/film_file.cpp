// The sums of a film as bytes: a line of text that names the picture, each array with its size, a hash of
// all.
#include <array>
#include <cstring>
#include <istream>
#include <ostream>
#include <string>
#include <vector>

#include "base/content_hash.h"
#include "base/text_difference.h"
#include "film/film.h"
#include "relief/error.h"

namespace relief {

namespace {

constexpr std::string_view kStart = "relief film 3\n";

[[noreturn]] void refuse(const std::string& message) {
    throw Error(ErrorKind::bad_input, {message, "sums of samples to go on from",
                                       "go on with the settings that they were made with, or render anew"});
}

[[noreturn]] void refuse_damage(const std::string& message) {
    throw Error(ErrorKind::bad_input, {message, "sums of samples to go on from",
                                       "the file is cut off, or was changed: render anew"});
}

class Writer {
  public:
    explicit Writer(std::ostream& stream) : stream_(stream) {}

    template <class T> void add(const std::vector<T>& values) {
        const uint64_t count = values.size();
        add_bytes(&count, sizeof count), add_bytes(values.data(), count * sizeof(T));
    }
    void add(std::string_view text) { add(std::vector<char>(text.begin(), text.end())); }
    void finish() {
        const uint64_t hash = hash_.value();
        stream_.write(reinterpret_cast<const char*>(&hash), sizeof hash);
    }

  private:
    void add_bytes(const void* bytes, size_t size) {
        hash_.add_bytes(bytes, size);
        stream_.write(static_cast<const char*>(bytes), std::streamsize(size));
    }

    std::ostream& stream_;
    ContentHash hash_;
};

class Reader {
  public:
    explicit Reader(std::istream& stream) : stream_(stream) {}

    /// `count`: what the film holds; another one is refused before anything is allocated for it.
    template <class T> void take(std::vector<T>& values, size_t most, size_t least) {
        uint64_t count = 0;
        take_bytes(&count, sizeof count);
        if (count > most || count < least)
            refuse("the sums of samples are of another picture, or of other layers");
        values.resize(size_t(count));
        take_bytes(values.data(), size_t(count) * sizeof(T));
    }
    template <class T> void take(std::vector<T>& values) { take(values, values.size(), values.size()); }
    std::string take_text(size_t most) {
        std::vector<char> text;
        take(text, most, 0);
        return {text.begin(), text.end()};
    }
    void finish() {
        const uint64_t expected = hash_.value();
        uint64_t hash = 0;
        if (!stream_.read(reinterpret_cast<char*>(&hash), sizeof hash) || hash != expected)
            refuse_damage("the sums of samples are damaged");
    }

  private:
    void take_bytes(void* bytes, size_t size) {
        if (!stream_.read(static_cast<char*>(bytes), std::streamsize(size)))
            refuse_damage("the sums of samples end too early");
        hash_.add_bytes(bytes, size);
    }

    std::istream& stream_;
    ContentHash hash_;
};

} // namespace

void Film::write(std::ostream& stream, const std::string& identity) const {
    Writer writer(stream);
    writer.add(kStart), writer.add(identity);
    writer.add(sums_), writer.add(counts_), writer.add(hit_counts_), writer.add(depths_), writer.add(ids_);
    if (objects_) writer.add(objects_->slots());
    if (materials_) writer.add(materials_->slots());
    if (batches_) writer.add(batches_->pixels());
    writer.add(std::vector<int32_t>{passes.target}), writer.add(passes.is_active);
    writer.finish();
}

void Film::read(std::istream& stream, const std::string& identity) {
    Reader reader(stream);
    if (reader.take_text(kStart.size()) != kStart)
        refuse("this holds no sums of samples, or those of another version");
    const std::string found = reader.take_text(1 << 16);
    if (found != identity)
        refuse("the sums of samples are of another picture: " + describe_difference(identity, found));
    reader.take(sums_), reader.take(counts_), reader.take(hit_counts_), reader.take(depths_),
        reader.take(ids_);
    if (objects_) reader.take(objects_->slots());
    if (materials_) reader.take(materials_->slots());
    if (batches_) reader.take(batches_->pixels());
    std::vector<int32_t> target(1);
    reader.take(target), reader.take(passes.is_active, counts_.size(), 0);
    passes.target = target[0];
    reader.finish();
}

} // namespace relief
