use std::io::{Read, Write};

use morec::TimeSpan;
use morec::classes::ClassId;
use morec::live::{Event, PerformerId, Phase};
use tungstenite::client::IntoClientRequest;

use super::*;

fn event(sequence: u64) -> Event {
    Event {
        phase: Phase::End,
        motion: sequence,
        sequence,
        actor: PerformerId(0),
        class: ClassId(0),
        score: 0.5,
        progress: 1.0,
        span: TimeSpan::new(1.0, 2.0),
        reported_secs: 2.1,
        repetitions: None,
        pace: None,
        deviation: None,
        wall_secs: 1.0e9,
    }
}

fn sink() -> (WebSocketSink, SocketAddr) {
    WebSocketSink::listen("127.0.0.1:0".parse().unwrap(), None).unwrap()
}

/// Waits until something is true, without a limit.
fn until(mut is: impl FnMut() -> bool) {
    while !is() {
        thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn a_listener_hears_every_event_and_the_end() {
    let (mut sink, at) = sink();
    let (mut socket, _) = tungstenite::connect(format!("ws://{at}")).unwrap();
    until(|| !sink.hall.lock().listeners.is_empty());
    for sequence in 1..=3 {
        sink.emit(&NamedEvent {
            event: &event(sequence),
            class: "wave",
            source: "test",
        })
        .unwrap();
    }
    for sequence in 1..=3 {
        let text = socket.read().unwrap().into_text().unwrap();
        let told: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(
            (told["class"].as_str(), told["sequence"].as_u64()),
            (Some("wave"), Some(sequence))
        );
    }
    drop(sink);
    assert!(matches!(socket.read(), Ok(Message::Close(_))));
}

#[test]
fn a_listener_that_leaves_makes_room_at_once() {
    let (sink, at) = sink();
    for _ in 0..3 {
        let (mut socket, _) = tungstenite::connect(format!("ws://{at}")).unwrap();
        until(|| sink.hall.lock().listeners.len() == 1);
        socket.close(None).unwrap();
        // Without any event.
        until(|| sink.hall.lock().listeners.is_empty());
    }
}

#[test]
fn large_messages_end_the_connection() {
    let (sink, at) = sink();
    let (mut socket, _) = tungstenite::connect(format!("ws://{at}")).unwrap();
    until(|| sink.hall.lock().listeners.len() == 1);
    let _ = socket.send(Message::text("x".repeat(100_000)));
    until(|| sink.hall.lock().listeners.is_empty());
}

#[test]
fn connections_that_say_nothing_are_few_and_let_go() {
    let (sink, at) = sink();
    let silent: Vec<TcpStream> = (0..3 * GREETING)
        .map(|_| TcpStream::connect(at).unwrap())
        .collect();
    // The last one is not waited for: its connection is closed.
    let mut last = &silent[silent.len() - 1];
    assert_eq!(last.read(&mut [0; 1]).unwrap_or(0), 0);
    assert!(sink.hall.lock().greeting <= GREETING);
    // A byte now and then does not buy time.
    until(|| {
        let _ = (&silent[0]).write_all(b"G");
        sink.hall.lock().greeting == 0
    });
    let (_socket, _) = tungstenite::connect(format!("ws://{at}")).unwrap();
    until(|| sink.hall.lock().listeners.len() == 1);
}

#[test]
fn pages_from_elsewhere_may_not_listen() {
    let origin = Some("https://studio.example".to_owned());
    let (_sink, at) = WebSocketSink::listen("127.0.0.1:0".parse().unwrap(), origin).unwrap();
    let connects = |origin: Option<&str>| {
        let mut request = format!("ws://{at}").into_client_request().unwrap();
        if let Some(origin) = origin {
            request
                .headers_mut()
                .insert("Origin", origin.parse().unwrap());
        }
        tungstenite::connect(request).is_ok()
    };
    assert!(connects(None) && connects(Some("http://localhost:8000")));
    assert!(connects(Some("https://studio.example")));
    assert!(!connects(Some("https://evil.example")) && !connects(Some("null")));
}
