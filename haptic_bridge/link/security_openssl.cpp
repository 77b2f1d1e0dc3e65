// SPDX-License-Identifier: Apache-2.0
// The module that uses OpenSSL. TLS runs over memory instead of a socket, as it does inside Asio's own stream. The
// sockets stay in the program, because a module must not share the program's Asio.
#include <openssl/crypto.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/rand.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <algorithm>
#include <stdexcept>

#include "haptic_bridge/link/security.hpp"

namespace haptic_bridge {
namespace {

template <auto function>
struct Frees {
    template <class Thing>
    void operator()(Thing* thing) const {
        function(thing);
    }
};
using Context = std::unique_ptr<SSL_CTX, Frees<SSL_CTX_free>>;

constexpr std::size_t kBinding = 32;       // [byte]
constexpr std::size_t kPiece = 16 * 1024;  // [byte], largest payload of a TLS record
// [s]. It is long because the other end does not check it, and clocks on a stage are often wrong.
constexpr long kValidity = 365L * 24 * 3600 * 20;

/// Returns the first error of OpenSSL as text, or `otherwise` if it has none. Forgets all other errors.
std::string complaint(const std::string& otherwise) {
    const unsigned long error = ERR_get_error();
    ERR_clear_error();
    const char* reason = error == 0 ? nullptr : ERR_reason_error_string(error);
    return reason == nullptr ? otherwise : reason;
}

void require(bool good, const std::string& what) {
    if (!good) {
        throw std::runtime_error(complaint(what));
    }
}

class OpensslSession : public TlsSession {
public:
    OpensslSession(SSL_CTX* context, bool server) : ssl_(SSL_new(context)) {
        BIO* in = BIO_new(BIO_s_mem());
        BIO* out = BIO_new(BIO_s_mem());
        require(ssl_ && in != nullptr && out != nullptr, "out of memory");
        SSL_set_bio(ssl_.get(), in, out);
        server ? SSL_set_accept_state(ssl_.get()) : SSL_set_connect_state(ssl_.get());
    }

    void begin(base::Bytes& reply) override {
        ERR_clear_error();
        (void)go(SSL_do_handshake(ssl_.get()), reply);
        take(reply);
    }

    void receive(ByteSpan bytes, base::Bytes& plain, base::Bytes& reply) override {
        ERR_clear_error();
        if ((SSL_get_shutdown(ssl_.get()) & SSL_RECEIVED_SHUTDOWN) != 0) {
            // OpenSSL does not read any more, and would keep all bytes in memory.
            throw std::runtime_error("it sent data after it had closed TLS");
        }
        require(BIO_write(SSL_get_rbio(ssl_.get()), bytes.data(), static_cast<int>(bytes.size())) ==
                    static_cast<int>(bytes.size()),
                "out of memory");
        if (!established() && !go(SSL_do_handshake(ssl_.get()), reply)) {
            take(reply);
            return;
        }
        std::array<std::uint8_t, kPiece> piece{};
        while (true) {
            std::size_t count = 0;
            const int result = SSL_read_ex(ssl_.get(), piece.data(), piece.size(), &count);
            if (!go(result, reply)) {
                break;
            }
            plain.insert(plain.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(count));
        }
        take(reply);
    }

    void seal(ByteSpan plain, base::Bytes& sealed) override {
        ERR_clear_error();
        // Encrypts piece by piece. OpenSSL's output buffer never shrinks, and a state of the sand is large.
        for (; !plain.empty(); plain = plain.subspan(std::min(plain.size(), kPiece))) {
            const ByteSpan piece = plain.first(std::min(plain.size(), kPiece));
            std::size_t count = 0;
            require(SSL_write_ex(ssl_.get(), piece.data(), piece.size(), &count) == 1 && count == piece.size(),
                    "the bytes cannot be encrypted");
            take(sealed);
        }
    }

    [[nodiscard]] bool established() const override { return SSL_is_init_finished(ssl_.get()) == 1; }

    [[nodiscard]] base::Bytes binding() const override {
        static constexpr std::string_view kLabel = "EXPORTER-Channel-Binding";
        base::Bytes bytes(kBinding);
        require(SSL_export_keying_material(ssl_.get(), bytes.data(), bytes.size(), kLabel.data(), kLabel.size(),
                                           nullptr, 0, 0) == 1,
                "no keying material");
        return bytes;
    }

private:
    /// Returns false if the other end must send more first, or has closed TLS. Throws std::runtime_error if the
    /// connection is broken.
    bool go(int result, base::Bytes& reply) {
        if (result == 1) {
            return true;
        }
        const int error = SSL_get_error(ssl_.get(), result);
        if (error == SSL_ERROR_WANT_READ || error == SSL_ERROR_ZERO_RETURN) {
            return false;
        }
        take(reply);
        throw std::runtime_error(complaint("the connection is broken"));
    }

    void take(base::Bytes& bytes) {
        BIO* out = SSL_get_wbio(ssl_.get());
        const std::size_t end = bytes.size();
        const std::size_t count = BIO_ctrl_pending(out);
        bytes.resize(end + count);
        if (count > 0) {
            (void)BIO_read(out, bytes.data() + end, static_cast<int>(count));
        }
    }

    std::unique_ptr<SSL, Frees<SSL_free>> ssl_;
};

class OpenTls : public TlsContext {
public:
    OpenTls(Context context, bool server) : context_(std::move(context)), server_(server) {}
    [[nodiscard]] std::unique_ptr<TlsSession> open() const override {
        return std::make_unique<OpensslSession>(context_.get(), server_);
    }

private:
    Context context_;
    bool server_;
};

Context contextOf(const SSL_METHOD* method) {
    Context context(SSL_CTX_new(method));
    require(context && SSL_CTX_set_min_proto_version(context.get(), TLS1_3_VERSION) == 1, "OpenSSL has no TLS 1.3");
    SSL_CTX_set_verify(context.get(), SSL_VERIFY_NONE, nullptr);
    // Disables session resumption: every connection does the whole handshake.
    SSL_CTX_set_num_tickets(context.get(), 0);
    SSL_CTX_set_session_cache_mode(context.get(), SSL_SESS_CACHE_OFF);
    return context;
}

/// Makes a key that lives as long as the program, and a certificate without information.
void makeCertificate(SSL_CTX* context) {
    const std::unique_ptr<EVP_PKEY, Frees<EVP_PKEY_free>> key(EVP_EC_gen("P-256"));
    const std::unique_ptr<X509, Frees<X509_free>> certificate(X509_new());
    require(key && certificate, "no key can be made");
    X509* x509 = certificate.get();
    X509_set_version(x509, 2);
    ASN1_INTEGER_set(X509_get_serialNumber(x509), 1);
    X509_gmtime_adj(X509_getm_notBefore(x509), -kValidity);
    X509_gmtime_adj(X509_getm_notAfter(x509), kValidity);
    static constexpr unsigned char kName[] = "sandwall";
    X509_NAME_add_entry_by_txt(X509_get_subject_name(x509), "CN", MBSTRING_ASC, kName, -1, -1, 0);
    X509_set_issuer_name(x509, X509_get_subject_name(x509));
    require(X509_set_pubkey(x509, key.get()) == 1 && X509_sign(x509, key.get(), EVP_sha256()) > 0 &&
                SSL_CTX_use_certificate(context, x509) == 1 && SSL_CTX_use_PrivateKey(context, key.get()) == 1,
            "no certificate can be made");
}

class OpenSsl : public Security {
public:
    void random(std::span<std::uint8_t> bytes) const override {
        require(RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) == 1, "no random bytes");
    }

    [[nodiscard]] std::array<std::uint8_t, 32> hmacSha256(ByteSpan key, ByteSpan message) const override {
        std::array<std::uint8_t, 32> mac{};
        std::size_t size = 0;
        require(EVP_Q_mac(nullptr, "HMAC", nullptr, "SHA256", nullptr, key.data(), key.size(), message.data(),
                          message.size(), mac.data(), mac.size(), &size) != nullptr &&
                    size == mac.size(),
                "no HMAC-SHA-256");
        return mac;
    }

    [[nodiscard]] bool equal(ByteSpan one, ByteSpan other) const override {
        return one.size() == other.size() && CRYPTO_memcmp(one.data(), other.data(), one.size()) == 0;
    }

    [[nodiscard]] std::unique_ptr<TlsContext> tlsServer(const std::string& certificate,
                                                        const std::string& key) const override {
        ERR_clear_error();
        Context context = contextOf(TLS_server_method());
        if (certificate.empty()) {
            makeCertificate(context.get());
        } else {
            require(SSL_CTX_use_certificate_chain_file(context.get(), certificate.c_str()) == 1,
                    certificate + " holds no certificate");
            require(SSL_CTX_use_PrivateKey_file(context.get(), key.c_str(), SSL_FILETYPE_PEM) == 1,
                    key + " holds no key");
            require(SSL_CTX_check_private_key(context.get()) == 1, "the key is not the certificate's");
        }
        return std::make_unique<OpenTls>(std::move(context), true);
    }

    [[nodiscard]] std::unique_ptr<TlsContext> tlsClient() const override {
        ERR_clear_error();
        return std::make_unique<OpenTls>(contextOf(TLS_client_method()), false);
    }
};

}  // namespace

extern "C" const Security* sandwallSecurity1() {
    static const OpenSsl security;
    return &security;
}

}  // namespace haptic_bridge
