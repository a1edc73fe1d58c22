// SHA-256 as the API spells it: "sha256:" and 64 hexadecimal digits.
//
// Threads: a ContentHash belongs to one thread at a time. Errors: none; OpenSSL
// fails here only when memory runs out, which ends the process.
#ifndef TERRANE_SERVER_CONVERT_CONTENT_HASH_H_
#define TERRANE_SERVER_CONVERT_CONTENT_HASH_H_

#include <google/protobuf/message.h>
#include <openssl/evp.h>

#include <memory>
#include <string>
#include <string_view>

namespace terrane::server {

class ContentHash {
 public:
  ContentHash();

  void Add(std::string_view bytes);
  // A number by its bytes; the API's are little-endian, and so is this machine.
  template <typename Number>
  void AddNumber(Number number) {
    Add({reinterpret_cast<const char*>(&number), sizeof number});
  }
  // The hash of all that was added; call it once.
  std::string Finish();

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context_;
};

// The bytes that stand for a recipe: equal recipes have equal bytes.
std::string CanonicalBytes(const google::protobuf::Message& recipe);

// Hash of a recipe's canonical bytes. Only the hash of a resolved recipe names
// a world: an unresolved one leaves out what the defaults say.
std::string RecipeHash(const google::protobuf::Message& recipe);

}  // namespace terrane::server

#endif  // TERRANE_SERVER_CONVERT_CONTENT_HASH_H_
