#include "server/service/tls.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

namespace terrane::server {
namespace {

using grpc::experimental::FileWatcherCertificateProvider;
using grpc::experimental::TlsServerCredentialsOptions;

using Bio = std::unique_ptr<BIO, decltype(&BIO_free_all)>;
using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;
using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;

// Instead of asking the terminal.
int NoPassword(char*, int, int, void*) { return -1; }

absl::Status FileError(const char* flag, const std::string& file,
                       const char* problem) {
  ERR_clear_error();
  return absl::InvalidArgumentError(std::string(flag) + " " + file + " " +
                                    problem);
}

absl::StatusOr<Certificate> ReadCertificate(const char* flag,
                                            const std::string& file) {
  const Bio bio(BIO_new_file(file.c_str(), "r"), BIO_free_all);
  if (bio == nullptr) return FileError(flag, file, "cannot be read");
  Certificate certificate(
      PEM_read_bio_X509(bio.get(), nullptr, NoPassword, nullptr), X509_free);
  if (certificate == nullptr) {
    return FileError(flag, file, "must hold a certificate in PEM");
  }
  return certificate;
}

absl::StatusOr<Key> ReadKey(const char* flag, const std::string& file) {
  const Bio bio(BIO_new_file(file.c_str(), "r"), BIO_free_all);
  if (bio == nullptr) return FileError(flag, file, "cannot be read");
  Key key(PEM_read_bio_PrivateKey(bio.get(), nullptr, NoPassword, nullptr),
          EVP_PKEY_free);
  if (key == nullptr) {
    return FileError(flag, file,
                     "must hold a private key in PEM, without a password");
  }
  return key;
}

// gRPC would take any files and fail every handshake later.
absl::Status CheckFiles(const TlsFiles& files) {
  const auto certificate = ReadCertificate("--tls-cert", files.certificate);
  if (!certificate.ok()) return certificate.status();
  const auto key = ReadKey("--tls-key", files.key);
  if (!key.ok()) return key.status();
  if (X509_check_private_key(certificate->get(), key->get()) != 1) {
    return FileError("--tls-key", files.key,
                     "is not the key of the certificate in --tls-cert");
  }
  if (files.client_ca.empty()) return absl::OkStatus();
  return ReadCertificate("--tls-client-ca", files.client_ca).status();
}

}  // namespace

absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> MakeServerCredentials(
    const TlsFiles& files) {
  if (!files.on()) return grpc::InsecureServerCredentials();
  const absl::Status checked = CheckFiles(files);
  if (!checked.ok()) return checked;
  // gRPC's default range is TLS 1.2 to 1.3.
  TlsServerCredentialsOptions options(
      std::make_shared<FileWatcherCertificateProvider>(
          files.key, files.certificate, files.client_ca,
          static_cast<unsigned>(files.refresh.count())));
  options.watch_identity_key_cert_pairs();
  if (!files.client_ca.empty()) {
    options.watch_root_certs();
    options.set_cert_request_type(
        GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  }
  return grpc::experimental::TlsServerCredentials(options);
}

}  // namespace terrane::server
