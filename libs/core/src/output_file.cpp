#include <priormap/core/output_file.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <streambuf>
#include <utility>
#include <vector>

#include <priormap/core/error.hpp>

namespace priormap {

class OutputFile::Buffer : public std::streambuf {
 public:
  explicit Buffer(std::filesystem::path file) : file_(std::move(file)), block_(1 << 16) {
    descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw IoError(file_, std::string("cannot be created: ") + std::strerror(errno));
    setp(block_.data(), block_.data() + block_.size());
  }
  ~Buffer() override {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  void close() {
    if (descriptor_ < 0) return;
    drain();
    const int descriptor = std::exchange(descriptor_, -1);
    if (::close(descriptor) != 0) fail();
  }

 protected:
  int_type overflow(int_type c) override {
    drain();
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }

  std::streamsize xsputn(const char* text, std::streamsize size) override {
    if (size == 0) return 0;
    if (size < epptr() - pptr()) {
      std::memcpy(pptr(), text, static_cast<std::size_t>(size));
      pbump(static_cast<int>(size));
    } else {
      drain();
      write(text, size);
    }
    return size;
  }

  int sync() override {
    drain();
    return 0;
  }

  pos_type seekoff(off_type offset, std::ios_base::seekdir direction, std::ios_base::openmode) override {
    drain();
    const int whence = direction == std::ios_base::beg ? SEEK_SET : direction == std::ios_base::cur ? SEEK_CUR : SEEK_END;
    return pos_type(::lseek(descriptor_, offset, whence));
  }

  pos_type seekpos(pos_type position, std::ios_base::openmode mode) override {
    return seekoff(off_type(position), std::ios_base::beg, mode);
  }

 private:
  [[noreturn]] void fail() const { throw IoError(file_, std::string("cannot be written: ") + std::strerror(errno)); }

  void drain() {
    const auto size = pptr() - pbase();
    setp(block_.data(), block_.data() + block_.size());
    write(block_.data(), size);
  }

  void write(const char* data, std::streamsize size) {
    while (size > 0) {
      const ssize_t written = ::write(descriptor_, data, static_cast<std::size_t>(size));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail();
      data += written;
      size -= written;
    }
  }

  std::filesystem::path file_;
  std::vector<char> block_;
  int descriptor_ = -1;
};

OutputFile::OutputFile(const std::filesystem::path& file) : std::ostream(nullptr), buffer_(std::make_unique<Buffer>(file)) {
  rdbuf(buffer_.get());
  exceptions(std::ios_base::badbit | std::ios_base::failbit);
}

OutputFile::~OutputFile() {
  try {
    close();
  } catch (const IoError&) {
    // close() was not called: the caller is already leaving with an error of its own.
  }
}

void OutputFile::close() { buffer_->close(); }

}  // namespace priormap
