#include <priormap/core/hash.hpp>

#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

void require(int success) {
  if (success != 1) throw Error("SHA-256 is not available in this libcrypto");
}

}  // namespace

struct Sha256::State {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  State() { require(EVP_DigestInit_ex(context, EVP_sha256(), nullptr)); }
  ~State() { EVP_MD_CTX_free(context); }
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::update(std::span<const std::byte> bytes) { require(EVP_DigestUpdate(state_->context, bytes.data(), bytes.size())); }

void Sha256::update(const std::string& text) { update(std::as_bytes(std::span(text))); }

std::string Sha256::hex_digest() {
  std::array<unsigned char, 32> digest;
  require(EVP_DigestFinal_ex(state_->context, digest.data(), nullptr));
  std::string hex;
  for (const unsigned char byte : digest) {
    hex += "0123456789abcdef"[byte >> 4];
    hex += "0123456789abcdef"[byte & 15];
  }
  return hex;
}

std::string sha256_file(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw IoError(file, std::string("cannot be read: ") + std::strerror(errno));
  Sha256 sha;
  std::vector<std::byte> block(1 << 18);
  ssize_t size;
  while ((size = ::read(descriptor, block.data(), block.size())) > 0 || (size < 0 && errno == EINTR))
    if (size > 0) sha.update(std::span(block).first(static_cast<std::size_t>(size)));
  const int error = errno;
  ::close(descriptor);
  if (size < 0) throw IoError(file, std::string("cannot be read: ") + std::strerror(error));
  return sha.hex_digest();
}

}  // namespace priormap
