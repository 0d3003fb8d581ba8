#![no_main]
//! Any bytes from a WebSocket listener: no panic in the handshake or in the frames after it, nor a message above
//! the limit. What does not begin with a
//! handshake gets a good one before it: chance would seldom find one.

use libfuzzer_sys::fuzz_target;

const HELLO: &[u8] = b"GET / HTTP/1.1\r\nHost: a\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
    Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";

fuzz_target!(|bytes: &[u8]| {
    let bytes = match bytes.starts_with(b"GET") {
        true => bytes.to_vec(),
        false => [HELLO, bytes].concat(),
    };
    assert!(
        morec_live::heard(&bytes)
            .iter()
            .all(|length| *length <= 4096)
    );
});
