#include "server/convert/content_hash.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <array>
#include <bit>
#include <cstdlib>

namespace terrane::server {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the API's bytes are little-endian and written as they lie");

void Check(int openssl_result) {
  if (openssl_result != 1) std::abort();
}

}  // namespace

ContentHash::ContentHash() : context_(EVP_MD_CTX_new()) {
  Check(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}

void ContentHash::Add(std::string_view bytes) {
  Check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
}

std::string ContentHash::Finish() {
  constexpr char kDigits[] = "0123456789abcdef";
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned int size = 0;
  Check(EVP_DigestFinal_ex(context_.get(), digest.data(), &size));
  std::string text = "sha256:";
  for (unsigned int i = 0; i < size; ++i) {
    text.push_back(kDigits[digest[i] >> 4]);
    text.push_back(kDigits[digest[i] & 15]);
  }
  return text;
}

std::string CanonicalBytes(const google::protobuf::Message& recipe) {
  std::string bytes;
  {
    google::protobuf::io::StringOutputStream sink(&bytes);
    google::protobuf::io::CodedOutputStream out(&sink);
    out.SetSerializationDeterministic(true);
    recipe.SerializeToCodedStream(&out);
  }
  return bytes;
}

std::string RecipeHash(const google::protobuf::Message& recipe) {
  ContentHash hash;
  hash.Add(CanonicalBytes(recipe));
  return hash.Finish();
}

}  // namespace terrane::server
