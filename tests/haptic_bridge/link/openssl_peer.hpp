// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <memory>

#include "base/byte_stream.hpp"
#include "haptic_bridge/link/security.hpp"

namespace test {

/// One end of a TLS connection, as another program may offer it: with an older version of TLS. It uses OpenSSL itself
/// and no code of the link.
class OpenSslPeer {
public:
    /// `newest` is the newest version that this end offers, such as TLS1_2_VERSION.
    OpenSslPeer(bool server, int newest)
        : context_(SSL_CTX_new(server ? TLS_server_method() : TLS_client_method()), SSL_CTX_free) {
        EXPECT_EQ(SSL_CTX_set_max_proto_version(context_.get(), newest), 1);
        if (server) {
            useCertificate();
        }
        ssl_ = {SSL_new(context_.get()), SSL_free};
        SSL_set_bio(ssl_.get(), BIO_new(BIO_s_mem()), BIO_new(BIO_s_mem()));
        server ? SSL_set_accept_state(ssl_.get()) : SSL_set_connect_state(ssl_.get());
    }

    /// Takes `bytes` from the other end, and returns what to send to it.
    [[nodiscard]] base::Bytes exchange(haptic_bridge::ByteSpan bytes) {
        if (!bytes.empty()) {
            (void)BIO_write(SSL_get_rbio(ssl_.get()), bytes.data(), static_cast<int>(bytes.size()));
        }
        (void)SSL_do_handshake(ssl_.get());
        base::Bytes reply(BIO_ctrl_pending(SSL_get_wbio(ssl_.get())));
        if (!reply.empty()) {
            (void)BIO_read(SSL_get_wbio(ssl_.get()), reply.data(), static_cast<int>(reply.size()));
        }
        return reply;
    }
    [[nodiscard]] bool established() const { return SSL_is_init_finished(ssl_.get()) == 1; }
    [[nodiscard]] int version() const { return SSL_version(ssl_.get()); }

private:
    void useCertificate() {
        const std::unique_ptr<EVP_PKEY, void (*)(EVP_PKEY*)> key(EVP_EC_gen("P-256"), EVP_PKEY_free);
        const std::unique_ptr<X509, void (*)(X509*)> certificate(X509_new(), X509_free);
        X509_gmtime_adj(X509_getm_notBefore(certificate.get()), 0);
        X509_gmtime_adj(X509_getm_notAfter(certificate.get()), 3600);
        X509_set_pubkey(certificate.get(), key.get());
        EXPECT_GT(X509_sign(certificate.get(), key.get(), EVP_sha256()), 0);
        EXPECT_EQ(SSL_CTX_use_certificate(context_.get(), certificate.get()), 1);
        EXPECT_EQ(SSL_CTX_use_PrivateKey(context_.get(), key.get()), 1);
    }

    std::unique_ptr<SSL_CTX, void (*)(SSL_CTX*)> context_;
    std::unique_ptr<SSL, void (*)(SSL*)> ssl_{nullptr, SSL_free};
};

}  // namespace test
