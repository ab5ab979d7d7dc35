//! Names for objects that have none, made of what they are: the order of objects in a file never matters, so neither may
//! their names depend on it.

use std::collections::{BTreeMap, BTreeSet};

/// Hands out names.
#[derive(Default)]
pub(super) struct Names {
    used: BTreeMap<String, u32>,
}

impl Names {
    /// A name for an unnamed object of the given kind and content. Objects that are identical get running numbers: exchanging
    /// them changes nothing.
    pub(super) fn for_content(&mut self, kind: &str, content: &str) -> String {
        let base = format!("{kind}#{:016x}", fnv1a(content.as_bytes()));
        let number = self.used.entry(base.clone()).or_insert(0);
        *number += 1;
        if *number == 1 { base } else { format!("{base}-{number}") }
    }
}

/// Names for the parts of the model `base`, whose own names are `parts`: the model's where there is one part, else
/// `base/part`. Parts without a name, and those that share one, are numbered.
pub(super) fn of_parts(base: &str, parts: &[&str]) -> Vec<String> {
    if parts.len() == 1 {
        return vec![base.to_owned()];
    }
    let own: BTreeSet<&str> = parts.iter().copied().collect();
    let mut used = BTreeSet::new();
    let mut free = |part: &str| {
        let numbered = |number: usize| match part {
            "" => number.to_string(),
            part => format!("{part}-{number}"),
        };
        let mut name = if part.is_empty() { numbered(1) } else { part.to_owned() };
        let mut number = 1;
        // The first that bears a name keeps it.
        while used.contains(&name) || (name != part && own.contains(name.as_str())) {
            number += 1;
            name = numbered(number);
        }
        used.insert(name.clone());
        name
    };
    parts.iter().map(|part| format!("{base}/{}", free(part))).collect()
}

/// The 64-bit hash of G. Fowler, L. C. Noll and K.-P. Vo, variant 1a: the same on every machine.
pub(crate) fn fnv1a(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test vectors of the hash's authors.
    #[test]
    fn the_hash_is_the_published_one() {
        assert_eq!(fnv1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn parts_have_names_of_their_own() {
        assert_eq!(of_parts("cup", &["handle"]), ["cup"]);
        assert_eq!(of_parts("cup", &["handle", "rim"]), ["cup/handle", "cup/rim"]);
        assert_eq!(of_parts("cup", &["", "1", "2"]), ["cup/3", "cup/1", "cup/2"]);
        assert_eq!(of_parts("cup", &["a", "a", "a-2", "a"]), ["cup/a", "cup/a-3", "cup/a-2", "cup/a-4"]);
    }

    #[test]
    fn identical_objects_are_numbered() {
        let mut names = Names::default();
        let first = names.for_content("sphere", "r = 1");
        assert_ne!(names.for_content("sphere", "r = 2"), first);
        assert_eq!(names.for_content("sphere", "r = 1"), format!("{first}-2"));
    }
}
