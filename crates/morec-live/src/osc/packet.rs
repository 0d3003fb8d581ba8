//! Open Sound Control 1.0, as much of it as poses and events need: packets to messages and back, nothing copied.
//!
//! Written here rather than taken from a crate because a packet must be readable without taking memory, must not be
//! able to exhaust the stack with bundles in bundles, and one broken message in a bundle must not cost the others.
//! Tests hold it against the crate `rosc`.

/// Bundles within bundles deeper than this are not believed.
const MAX_DEPTH: usize = 16;

/// First bytes of every bundle.
const BUNDLE: &[u8; 8] = b"#bundle\0";

/// An argument of a message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Arg<'a> {
    /// 32-bit integer, tag `i`.
    Int(i32),
    /// 32-bit float, tag `f`.
    Float(f32),
    /// `h`
    Long(i64),
    /// `d`
    Double(f64),
    /// `s` or `S`
    Text(&'a str),
    /// `T` or `F`
    Bool(bool),
    /// Any other kind, of which only the length matters here.
    Other,
}

impl Arg<'_> {
    /// As a real number, if it is a number at all.
    pub fn number(&self) -> Option<f64> {
        match self {
            Arg::Int(v) => Some(f64::from(*v)),
            Arg::Float(v) => Some(f64::from(*v)),
            Arg::Long(v) => Some(*v as f64),
            Arg::Double(v) => Some(*v),
            Arg::Bool(v) => Some(f64::from(u8::from(*v))),
            Arg::Text(_) | Arg::Other => None,
        }
    }
}

/// A message within a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Message<'a> {
    /// Address of the message, as `/VMC/Ext/Bone/Pos`.
    pub address: &'a str,
    tags: &'a [u8],
    data: &'a [u8],
}

impl<'a> Message<'a> {
    /// Its arguments, in order; they end early where the message does.
    pub fn args(&self) -> impl Iterator<Item = Arg<'a>> + 'a {
        let mut data = self.data;
        self.tags
            .iter()
            .map_while(move |tag| argument(*tag, &mut data))
    }
}

/// Calls `each` with every message of `packet`, bundles unpacked in order; returns how many parts of it could not be
/// understood. O(bytes), no allocation, no panic.
pub fn read<'a>(packet: &'a [u8], each: &mut impl FnMut(Message<'a>)) -> u64 {
    element(packet, 0, each)
}

fn element<'a>(bytes: &'a [u8], depth: usize, each: &mut impl FnMut(Message<'a>)) -> u64 {
    if !bytes.starts_with(BUNDLE) {
        return match message(bytes) {
            Some(message) => {
                each(message);
                0
            }
            None => 1,
        };
    }
    // Eight bytes of name, eight of a time that says "now" nearly always, and is not heeded.
    let Some(mut rest) = bytes.get(16..).filter(|_| depth < MAX_DEPTH) else {
        return 1;
    };
    let mut malformed = 0;
    while !rest.is_empty() {
        let size = take::<4>(&mut rest).map_or(-1, i32::from_be_bytes);
        match usize::try_from(size)
            .ok()
            .filter(|size| *size <= rest.len())
        {
            Some(size) => {
                malformed += element(&rest[..size], depth + 1, each);
                rest = &rest[size..];
            }
            // What follows has no beginning.
            None => return malformed + 1,
        }
    }
    malformed
}

fn message(bytes: &[u8]) -> Option<Message<'_>> {
    let mut rest = bytes;
    let address = text(&mut rest).filter(|address| address.starts_with('/'))?;
    // Senders of old leave the tags out where there is no argument.
    if rest.is_empty() {
        return Some(Message {
            address,
            tags: &[],
            data: &[],
        });
    }
    let tags = text(&mut rest)?.strip_prefix(',')?.as_bytes();
    Some(Message {
        address,
        tags,
        data: rest,
    })
}

fn take<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (head, rest) = bytes.split_first_chunk::<N>()?;
    *bytes = rest;
    Some(*head)
}

/// A text, its terminating zero, and zeros up to a multiple of four.
fn text<'a>(bytes: &mut &'a [u8]) -> Option<&'a str> {
    let end = bytes.iter().position(|b| *b == 0)?;
    let text = std::str::from_utf8(&bytes[..end]).ok()?;
    // The padding of a last text is left out by some.
    *bytes = bytes.get(end / 4 * 4 + 4..).unwrap_or_default();
    Some(text)
}

fn argument<'a>(tag: u8, data: &mut &'a [u8]) -> Option<Arg<'a>> {
    Some(match tag {
        b'i' => Arg::Int(i32::from_be_bytes(take(data)?)),
        b'f' => Arg::Float(f32::from_be_bytes(take(data)?)),
        b'h' => Arg::Long(i64::from_be_bytes(take(data)?)),
        b'd' => Arg::Double(f64::from_be_bytes(take(data)?)),
        b's' | b'S' => Arg::Text(text(data)?),
        b'T' => Arg::Bool(true),
        b'F' => Arg::Bool(false),
        b'N' | b'I' | b'[' | b']' => Arg::Other,
        b'c' | b'r' | b'm' => take::<4>(data).map(|_| Arg::Other)?,
        b't' => take::<8>(data).map(|_| Arg::Other)?,
        b'b' => {
            let size = usize::try_from(i32::from_be_bytes(take(data)?)).ok()?;
            *data = data.get(size.next_multiple_of(4)..)?;
            Arg::Other
        }
        _ => return None,
    })
}

/// Adds a message to `out`. Arguments of kind [`Arg::Other`] are written as nil.
pub fn write_message(out: &mut Vec<u8>, address: &str, args: &[Arg]) {
    write_text(out, address);
    let begun = out.len();
    out.push(b',');
    out.extend(args.iter().map(|arg| match arg {
        Arg::Int(_) => b'i',
        Arg::Float(_) => b'f',
        Arg::Long(_) => b'h',
        Arg::Double(_) => b'd',
        Arg::Text(_) => b's',
        Arg::Bool(true) => b'T',
        Arg::Bool(false) => b'F',
        Arg::Other => b'N',
    }));
    pad(out, begun);
    for arg in args {
        match arg {
            Arg::Int(v) => out.extend(v.to_be_bytes()),
            Arg::Float(v) => out.extend(v.to_be_bytes()),
            Arg::Long(v) => out.extend(v.to_be_bytes()),
            Arg::Double(v) => out.extend(v.to_be_bytes()),
            Arg::Text(v) => write_text(out, v),
            Arg::Bool(_) | Arg::Other => {}
        }
    }
}

/// Begins a bundle that takes effect at once.
pub fn begin_bundle(out: &mut Vec<u8>) {
    out.extend(BUNDLE);
    out.extend(1u64.to_be_bytes());
}

/// Adds what `write` writes to the bundle begun in `out`.
pub fn write_element(out: &mut Vec<u8>, write: impl FnOnce(&mut Vec<u8>)) {
    let begun = out.len();
    out.extend([0; 4]);
    write(out);
    let size = (out.len() - begun - 4) as u32;
    out[begun..begun + 4].copy_from_slice(&size.to_be_bytes());
}

fn write_text(out: &mut Vec<u8>, text: &str) {
    let begun = out.len();
    // A text ends at its first zero: what came after one would be lost or, worse, read as something else.
    out.extend(text.bytes().take_while(|b| *b != 0));
    pad(out, begun);
}

/// At least one zero, up to a multiple of four since `begun`.
fn pad(out: &mut Vec<u8>, begun: usize) {
    let length = ((out.len() - begun) / 4 + 1) * 4;
    out.resize(begun + length, 0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rosc::{OscBundle, OscMessage, OscPacket, OscTime, OscType};

    type Plain = (String, Vec<OscType>);

    fn arg() -> impl Strategy<Value = OscType> {
        prop_oneof![
            any::<i32>().prop_map(OscType::Int),
            (-1e6f32..1e6).prop_map(OscType::Float),
            any::<i64>().prop_map(OscType::Long),
            (-1e6f64..1e6).prop_map(OscType::Double),
            "[a-zA-Z手ü]{0,9}".prop_map(OscType::String),
            any::<bool>().prop_map(OscType::Bool),
            prop::collection::vec(any::<u8>(), 0..9).prop_map(OscType::Blob),
        ]
    }

    fn packet() -> impl Strategy<Value = OscPacket> {
        let message = ("/[a-zA-Z/]{0,9}", prop::collection::vec(arg(), 0..6))
            .prop_map(|(addr, args)| OscPacket::Message(OscMessage { addr, args }));
        message.prop_recursive(3, 12, 4, |inner| {
            prop::collection::vec(inner, 0..4).prop_map(|content| {
                OscPacket::Bundle(OscBundle {
                    timetag: OscTime {
                        seconds: 0,
                        fractional: 1,
                    },
                    content,
                })
            })
        })
    }

    fn flat(packet: &OscPacket, out: &mut Vec<Plain>) {
        match packet {
            OscPacket::Message(m) => out.push((m.addr.clone(), m.args.clone())),
            OscPacket::Bundle(b) => b.content.iter().for_each(|p| flat(p, out)),
        }
    }

    fn same(ours: &Arg, theirs: &OscType) -> bool {
        match (ours, theirs) {
            (Arg::Int(a), OscType::Int(b)) => a == b,
            (Arg::Float(a), OscType::Float(b)) => a == b,
            (Arg::Long(a), OscType::Long(b)) => a == b,
            (Arg::Double(a), OscType::Double(b)) => a == b,
            (Arg::Text(a), OscType::String(b)) => a == b,
            (Arg::Bool(a), OscType::Bool(b)) => a == b,
            (Arg::Other, OscType::Blob(_)) => true,
            _ => false,
        }
    }

    proptest! {
        #[test]
        fn what_another_library_writes_is_read(packet in packet()) {
            let bytes = rosc::encoder::encode(&packet).unwrap();
            let mut expected = vec![];
            flat(&packet, &mut expected);
            let mut found = vec![];
            prop_assert_eq!(read(&bytes, &mut |m| found.push(m)), 0);
            prop_assert_eq!(found.len(), expected.len());
            for (message, (address, args)) in found.iter().zip(&expected) {
                prop_assert_eq!(message.address, address);
                prop_assert_eq!(message.args().count(), args.len());
                prop_assert!(message.args().zip(args).all(|(a, b)| same(&a, b)));
            }
        }

        #[test]
        fn what_is_written_another_library_reads(
            address in "/[a-z/]{0,9}", int in any::<i32>(), float in -1e6f32..1e6, text in "[a-z手]{0,9}", yes: bool,
        ) {
            let args = [Arg::Int(int), Arg::Float(float), Arg::Text(&text), Arg::Bool(yes), Arg::Double(0.5)];
            let mut bytes = vec![];
            begin_bundle(&mut bytes);
            write_element(&mut bytes, |out| write_message(out, &address, &args));
            write_element(&mut bytes, |out| {
                begin_bundle(out);
                write_element(out, |out| write_message(out, "/b", &[]));
            });
            let (rest, packet) = rosc::decoder::decode_udp(&bytes).unwrap();
            prop_assert!(rest.is_empty());
            let mut found = vec![];
            flat(&packet, &mut found);
            prop_assert_eq!(found.len(), 2);
            prop_assert_eq!(&found[0].0, &address);
            prop_assert!(args.iter().zip(&found[0].1).all(|(a, b)| same(a, b)));
        }

        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), at in 0usize..100) {
            let mut framed = vec![];
            begin_bundle(&mut framed);
            write_element(&mut framed, |out| out.extend(&bytes));
            for mut packet in [bytes.clone(), framed] {
                read(&packet, &mut |m| { m.args().for_each(drop); });
                packet.truncate(at);
                read(&packet, &mut |m| { m.args().for_each(drop); });
            }
        }

        #[test]
        fn no_cut_or_changed_packet_panics(packet in packet(), at in any::<prop::sample::Index>(), byte: u8) {
            let mut bytes = rosc::encoder::encode(&packet).unwrap();
            let at = at.index(bytes.len().max(1));
            read(&bytes[..at.min(bytes.len())], &mut |m| { m.args().for_each(drop); });
            if let Some(there) = bytes.get_mut(at) {
                *there = byte;
            }
            read(&bytes, &mut |m| { m.args().for_each(drop); });
        }
    }

    #[test]
    fn one_broken_message_does_not_cost_the_others() {
        let mut bytes = vec![];
        begin_bundle(&mut bytes);
        write_element(&mut bytes, |out| write_message(out, "/a", &[Arg::Int(1)]));
        write_element(&mut bytes, |out| out.extend(b"what is this"));
        write_element(&mut bytes, |out| write_message(out, "/b", &[]));
        let mut found = vec![];
        assert_eq!(read(&bytes, &mut |m| found.push(m.address)), 1);
        assert_eq!(found, ["/a", "/b"]);
    }

    #[test]
    fn bundles_in_bundles_end_somewhere() {
        let mut bytes = vec![];
        for _ in 0..3000 {
            let inner = std::mem::take(&mut bytes);
            begin_bundle(&mut bytes);
            write_element(&mut bytes, |out| out.extend(&inner));
        }
        assert_eq!(read(&bytes, &mut |_| {}), 1);
    }
}
