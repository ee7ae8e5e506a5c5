//! Access to the server: for holders of its tokens, and from its own page.
//!
//! Login nodes are shared, so a port that anybody can reach is no protection. Nor is the address:
//! any page in a browser can send requests to a port of this machine.

use std::io;
use std::net::IpAddr;

use axum::http::header::{AUTHORIZATION, COOKIE, HOST, HeaderName, ORIGIN};
use axum::http::{HeaderMap, Method};

/// Where a browser says that a request comes from.
const SITE: HeaderName = HeaderName::from_static("sec-fetch-site");
/// Bytes of a token.
const BYTES: usize = 32;

/// The hosts that requests may name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Hosts {
    /// This machine, at this port.
    Own(u16),
    /// In addition this address, at the same port.
    And(IpAddr, u16),
    /// This machine at any port: the far end of a tunnel has its own port.
    Tunnel,
}

/// What the holder of a token may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Ask for everything that the server does.
    Any,
    /// Only look.
    Look,
}

/// The credentials that requests need: a token for each role.
#[derive(Debug)]
pub(super) struct Access {
    token: String,
    token_to_look: String,
    hosts: Hosts,
    cookie_name: String,
}

/// Why a request is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Refusal {
    /// It names another host: a name that was made to lead here.
    Host,
    /// It has no token, or a wrong one.
    Token,
    /// It was sent by another page.
    Origin,
}

/// `count` random bytes, in hexadecimal.
pub(super) fn random(count: usize) -> io::Result<String> {
    let mut bytes = vec![0; count];
    getrandom::fill(&mut bytes).map_err(io::Error::other)?;
    Ok(crate::text::in_hexadecimal(&bytes))
}

impl Hosts {
    /// Whether `host` is one of these.
    fn have(self, host: &str) -> bool {
        let own = |name: &str| ["127.0.0.1", "localhost", "[::1]"].contains(&name);
        let Some((name, port)) = host.rsplit_once(':') else {
            // The host of a tunnel that ends at port 80 has no port.
            return self == Self::Tunnel && own(host);
        };
        let digits = !port.is_empty() && port.bytes().all(|byte| byte.is_ascii_digit());
        let Some(port) = port.parse::<u16>().ok().filter(|_| digits) else {
            return false;
        };
        match self {
            Self::Own(here) => port == here && own(name),
            Self::Tunnel => own(name),
            Self::And(address, here) => port == here && (own(name) || is_address(name, address)),
        }
    }
}

/// Whether a name is this address, or any address if this one stands for all.
fn is_address(name: &str, address: IpAddr) -> bool {
    let bracketed = name
        .strip_prefix('[')
        .and_then(|name| name.strip_suffix(']'));
    let named = match bracketed {
        Some(name) => name.parse().map(IpAddr::V6),
        None => name.parse().map(IpAddr::V4),
    };
    // A page elsewhere reaches this server by a host name, never by an address.
    named.is_ok_and(|named| named == address || address.is_unspecified())
}

impl Access {
    /// Access with a new token.
    pub(super) fn new(hosts: Hosts) -> io::Result<Self> {
        let [token, token_to_look] = [random(BYTES)?, random(BYTES)?];
        // The ports of a host share their cookies, and a tunnel may end at any port.
        let cookie_name = match hosts {
            Hosts::Own(port) | Hosts::And(_, port) => format!("slipmap-{port}"),
            Hosts::Tunnel => format!("slipmap-{}", random(4)?),
        };
        Ok(Self {
            token,
            token_to_look,
            hosts,
            cookie_name,
        })
    }

    /// The token of a role.
    pub(super) fn token(&self, role: Role) -> &str {
        match role {
            Role::Any => &self.token,
            Role::Look => &self.token_to_look,
        }
    }

    /// The cookie that replaces the token in the link.
    pub(super) fn cookie(&self, role: Role) -> String {
        let (name, token) = (&self.cookie_name, self.token(role));
        format!("{name}={token}; HttpOnly; SameSite=Strict; Path=/")
    }

    /// The role whose token `offered` is.
    pub(super) fn role(&self, offered: &str) -> Option<Role> {
        let roles = [Role::Any, Role::Look].map(|role| (role, same(offered, self.token(role))));
        roles.into_iter().find_map(|(role, is)| is.then_some(role))
    }

    /// Checks that a request names this host, by a name that a browser on this machine has for it.
    pub(super) fn check_host(&self, headers: &HeaderMap) -> Result<(), Refusal> {
        match said(headers, &HOST) {
            Ok(Some(host)) if self.hosts.have(host) => Ok(()),
            _ => Err(Refusal::Host),
        }
    }

    /// The role of who sends a request, by the token that it has, as a cookie or as a bearer token.
    /// Unless it only reads, it must also come from the page itself or from no page.
    pub(super) fn check(&self, method: &Method, headers: &HeaderMap) -> Result<Role, Refusal> {
        let bearer = headers
            .get(AUTHORIZATION)
            .and_then(|value| value.to_str().ok());
        let bearer = bearer.and_then(|value| value.strip_prefix("Bearer "));
        let prefix = format!("{}=", self.cookie_name);
        let cookies = headers.get_all(COOKIE).iter();
        let cookies = cookies.filter_map(|value| value.to_str().ok());
        let mut cookies = cookies.flat_map(|value| value.split("; "));
        let cookie = cookies.find_map(|cookie| cookie.strip_prefix(&prefix));
        let mut offered = [bearer, cookie].into_iter().flatten();
        let Some(role) = offered.find_map(|token| self.role(token)) else {
            return Err(Refusal::Token);
        };
        match method == Method::GET || method == Method::HEAD || Self::is_own(headers) {
            true => Ok(role),
            false => Err(Refusal::Origin),
        }
    }

    /// Whether a request does not come from another page. What is said more than once is believed
    /// of no page: which of the values a program before this server has read is not known.
    fn is_own(headers: &HeaderMap) -> bool {
        let [site, origin, host] = [SITE, ORIGIN, HOST].map(|name| said(headers, &name));
        let (Ok(site), Ok(origin), Ok(host)) = (site, origin, host) else {
            return false;
        };
        let own = format!("http://{}", host.unwrap_or_default());
        site.is_none_or(|site| site == "same-origin") && origin.is_none_or(|origin| origin == own)
    }
}

/// Whether two texts are the same. The time taken does not reveal how much of them is.
fn same(offered: &str, token: &str) -> bool {
    let (offered, token) = (offered.as_bytes(), token.as_bytes());
    let differ = { offered.iter().zip(token) }.fold(0, |all, (a, b)| all | (a ^ b));
    offered.len() == token.len() && differ == 0
}

/// A header is there more than once, or is no text.
struct Unclear;

/// The value of a header; none where it is absent.
fn said<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Result<Option<&'a str>, Unclear> {
    let mut values = headers.get_all(name).iter();
    match (values.next(), values.next()) {
        (None, _) => Ok(None),
        (Some(value), None) => value.to_str().map(Some).map_err(|_| Unclear),
        _ => Err(Unclear),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    fn headers(list: &[(&'static str, String)]) -> HeaderMap {
        let mut headers = HeaderMap::new();
        for (name, value) in list {
            headers.append(*name, HeaderValue::from_str(value).unwrap());
        }
        headers
    }

    #[test]
    fn tokens_are_long_and_never_the_same() {
        let [one, other] = [(); 2].map(|()| Access::new(Hosts::Own(80)).unwrap());
        for role in [Role::Any, Role::Look] {
            let token = one.token(role);
            assert_eq!(token.len(), 2 * BYTES);
            assert_eq!(one.role(token), Some(role));
            for wrong in [other.token(role), "", &token[1..]] {
                assert_eq!(one.role(wrong), None);
            }
        }
    }

    #[test]
    fn only_own_names_are_answered() {
        let access = Access::new(Hosts::Own(8080)).unwrap();
        let check = |hosts: &[&str]| {
            let list: Vec<_> = hosts
                .iter()
                .map(|host| ("host", (*host).to_owned()))
                .collect();
            access.check_host(&headers(&list))
        };
        for host in ["127.0.0.1:8080", "localhost:8080", "[::1]:8080"] {
            assert_eq!(check(&[host]), Ok(()));
        }
        for hosts in [
            &["evil.example:8080"][..],
            &["127.0.0.1"],
            &["127.0.0.1:8081"],
            &["127.0.0.1:8080", "evil.example"],
            &["localhost:8080.evil.example"],
            &[],
        ] {
            assert_eq!(check(hosts), Err(Refusal::Host), "{hosts:?}");
        }
    }

    #[test]
    fn hosts_of_tunnels_and_other_addresses_are_told_apart() {
        let there: IpAddr = "192.0.2.7".parse().unwrap();
        let sixth: IpAddr = "2001:db8::7".parse().unwrap();
        let all: IpAddr = "0.0.0.0".parse().unwrap();
        for (hosts, good, bad) in [
            (
                Hosts::Tunnel,
                &["127.0.0.1:1", "localhost:8417", "[::1]:65535", "localhost"][..],
                &[
                    "evil.example:8417",
                    "evil.example",
                    "localhost:",
                    "localhost:x",
                    "1.2.3.4:1",
                ][..],
            ),
            (
                Hosts::And(there, 80),
                &["192.0.2.7:80", "localhost:80"],
                &[
                    "192.0.2.8:80",
                    "192.0.2.7:81",
                    "192.0.2.7",
                    "evil.example:80",
                ],
            ),
            (
                Hosts::And(sixth, 80),
                &["[2001:db8::7]:80", "[::1]:80"],
                &["2001:db8::7:80", "[2001:db8::8]:80", "[evil.example]:80"],
            ),
            (
                Hosts::And(all, 80),
                &["192.0.2.8:80", "10.0.0.1:80"],
                &["evil.example:80", "10.0.0.1:81", "10.0.0.1:080x"],
            ),
        ] {
            assert!(good.iter().all(|host| hosts.have(host)), "{hosts:?}");
            assert!(!bad.iter().any(|host| hosts.have(host)), "{hosts:?}");
        }
    }

    #[test]
    fn writes_come_from_the_page_itself() {
        let access = Access::new(Hosts::Own(8080)).unwrap();
        let cookie = (
            "cookie",
            format!("a=b; slipmap-8080={}", access.token(Role::Any)),
        );
        let host = ("host", "localhost:8080".to_owned());
        let own = ("origin", "http://localhost:8080".to_owned());
        let other = ("origin", "http://localhost:9090".to_owned());
        let cross = ("sec-fetch-site", "cross-site".to_owned());
        let check = |method, list: &[&(&'static str, String)]| {
            let list: Vec<_> = list.iter().map(|pair| (*pair).clone()).collect();
            access.check(&method, &headers(&list))
        };
        assert_eq!(check(Method::POST, &[&host, &cookie, &own]), Ok(Role::Any));
        assert_eq!(check(Method::POST, &[&host, &cookie]), Ok(Role::Any));
        assert_eq!(
            check(Method::POST, &[&host, &cookie, &other]),
            Err(Refusal::Origin)
        );
        assert_eq!(
            check(Method::POST, &[&host, &cookie, &cross]),
            Err(Refusal::Origin)
        );
        let same = ("sec-fetch-site", "same-origin".to_owned());
        assert_eq!(
            check(Method::POST, &[&host, &cookie, &own, &same]),
            Ok(Role::Any)
        );
        for twice in [
            [&own, &other],
            [&other, &own],
            [&own, &own],
            [&same, &cross],
        ] {
            let list = [&[&host, &cookie][..], &twice].concat();
            assert_eq!(
                check(Method::POST, &list),
                Err(Refusal::Origin),
                "{twice:?}"
            );
        }
        assert_eq!(check(Method::GET, &[&host, &cookie, &cross]), Ok(Role::Any));
        assert_eq!(check(Method::GET, &[&host]), Err(Refusal::Token));
        let bearer = (
            "authorization",
            format!("Bearer {}", access.token(Role::Any)),
        );
        assert_eq!(check(Method::GET, &[&host, &bearer]), Ok(Role::Any));
        let look = format!("Bearer {}", access.token(Role::Look));
        let look = ("authorization", look);
        assert_eq!(check(Method::GET, &[&host, &look]), Ok(Role::Look));
        let wrong = ("authorization", format!("Bearer {}", "0".repeat(64)));
        assert_eq!(check(Method::GET, &[&host, &wrong]), Err(Refusal::Token));
    }
}
