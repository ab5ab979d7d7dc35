//! Reads an MTL material library.
//!
//! `Kd`, `Ks`, `Ke`, `Tf` (one number or three), `Ns`, `Ni`, `d`, `Tr`, `illum` and `map_Kd` (with `-s`, `-o` and `-clamp`) are
//! read; other texture maps are counted; everything else is passed over. A statement that makes no sense is passed over as well and said, with its line: a
//! library is never a reason to refuse a model. (The OBJ library's own reader is not used here: it stops at the first
//! such line, panics at `Kd 1`, and does not know `Tf` and `Tr`.)

use vitrum_math::{DVec2, Rgb};

use super::lines;
use super::{MtlMap, MtlMaterial};

/// The materials of a library in file order, and what there is to say about it. `name` is for messages; the files that a library
/// names lie beside it, so their names begin with the folder that is in it.
pub(super) fn parse(name: &str, bytes: &[u8]) -> (Vec<MtlMaterial>, Vec<String>) {
    let folder = &name[..name.rfind(['/', '\\']).map_or(0, |slash| slash + 1)];
    let mut materials: Vec<MtlMaterial> = Vec::new();
    let mut maps = 0_u64;
    let mut problems = 0_u64;
    let mut first_problem = String::new();
    for statement in lines::statements(bytes) {
        let (keyword, rest) = lines::keyword_and_rest(&statement.text);
        if keyword == b"newmtl" {
            let undefined = MtlMaterial::undefined(&lines::readable(rest));
            materials.push(MtlMaterial { is_defined: true, ..undefined });
            continue;
        }
        // Statements before the first `newmtl` belong to nothing.
        let Some(material) = materials.last_mut() else { continue };
        let is_map = keyword.starts_with(b"map_") || keyword == b"bump";
        maps += u64::from(is_map && keyword != b"map_Kd");
        if let Err(expected) = set(material, keyword, rest, folder) {
            if problems == 0 {
                let (keyword, found) = (lines::readable(keyword), lines::quoted(rest));
                first_problem =
                    format!("line {}, {keyword}: found {found}, expected {expected}", statement.line);
            }
            problems += 1;
        }
    }
    let mut warnings = Vec::new();
    if problems > 0 {
        warnings.push(format!(
            "material library `{name}`: statements that make no sense, passed over: {problems} (first at {first_problem})"
        ));
    }
    if maps > 0 {
        warnings.push(format!("material library `{name}`: texture maps not used: {maps}"));
    }
    (materials, warnings)
}

/// Sets one property of a material; the error says what was expected.
fn set(material: &mut MtlMaterial, keyword: &[u8], rest: &[u8], folder: &str) -> Result<(), &'static str> {
    match keyword {
        b"map_Kd" => {
            material.map_kd = Some(map(rest, folder).ok_or("options and the name of an image file")?);
        }
        b"Kd" => material.kd = Some(color(rest, 1.0)?),
        b"Ks" => material.ks = Some(color(rest, 1.0)?),
        b"Ke" => material.ke = Some(color(rest, f64::MAX)?),
        b"Tf" => material.tf = Some(color(rest, 1.0)?),
        b"Ns" => material.ns = Some(single(rest, 0.0, f64::MAX).ok_or("a number, 0 or more")?),
        b"Ni" => material.ni = Some(single(rest, 0.001, 10.0).ok_or("a number from 0.001 to 10")?),
        b"d" => {
            let rest = rest.strip_prefix(b"-halo").unwrap_or(rest);
            material.d = Some(single(rest, 0.0, 1.0).ok_or(FRACTION)?);
        }
        // `d` says the same more clearly, and wins.
        b"Tr" => {
            let tr = single(rest, 0.0, 1.0).ok_or(FRACTION)?;
            material.d.get_or_insert(1.0 - tr);
        }
        b"illum" => {
            let model =
                lines::words(rest).next().and_then(|word| std::str::from_utf8(word).ok()?.parse().ok());
            material.illum = Some(model.filter(|model| *model <= 10).ok_or("a whole number from 0 to 10")?);
        }
        _ => {}
    }
    Ok(())
}

/// Options, then the name of a file, which may hold blanks.
fn map(mut rest: &[u8], folder: &str) -> Option<MtlMap> {
    let (mut scale, mut offset, mut clamp) = (DVec2::ONE, DVec2::ZERO, false);
    while rest.starts_with(b"-") {
        let (option, mut after) = lines::keyword_and_rest(rest);
        match option {
            b"-s" => scale = up_to_three(&mut after, scale),
            b"-o" => offset = up_to_three(&mut after, offset),
            b"-t" => drop(up_to_three(&mut after, DVec2::ZERO)),
            b"-clamp" => {
                let (word, beyond) = lines::keyword_and_rest(after);
                (clamp, after) = (word == b"on", beyond);
            }
            b"-mm" => (0..2).for_each(|_| after = lines::keyword_and_rest(after).1),
            b"-blendu" | b"-blendv" | b"-cc" | b"-texres" | b"-bm" | b"-imfchan" | b"-boost" | b"-type" => {
                after = lines::keyword_and_rest(after).1;
            }
            // A name may begin like this, too.
            _ => break,
        }
        rest = after;
    }
    let is_usable = scale.cmpne(DVec2::ZERO).all() && scale.is_finite() && offset.is_finite();
    let file = format!("{folder}{}", lines::readable(rest));
    (is_usable && !rest.is_empty()).then_some(MtlMap { file, scale, offset, clamp })
}

/// The first two of one to three numbers at the start of `rest`, which then begins after them; `default` stands for those that
/// are missing.
fn up_to_three(rest: &mut &[u8], default: DVec2) -> DVec2 {
    let mut numbers = default;
    for place in 0..3 {
        let (word, after) = lines::keyword_and_rest(rest);
        let Some(number) = lines::number(word) else { break };
        if place < 2 {
            numbers[place] = number;
        }
        *rest = after;
    }
    numbers
}

const FRACTION: &str = "a number from 0 to 1";

/// The first word as a number in a range.
fn single(rest: &[u8], least: f64, most: f64) -> Option<f64> {
    let number = lines::number(lines::words(rest).next()?)?;
    (least..=most).contains(&number).then_some(number)
}

/// `r g b`, or one number for all three.
fn color(rest: &[u8], most: f64) -> Result<Rgb, &'static str> {
    let expected = if most == 1.0 {
        "one number or three, from 0 to 1 (spectral and CIE XYZ colours are not read)"
    } else {
        "one number or three, 0 or more (spectral and CIE XYZ colours are not read)"
    };
    let mut channels = [0.0; 3];
    let mut count = 0;
    for (channel, word) in channels.iter_mut().zip(lines::words(rest)) {
        let number = lines::number(word).ok_or(expected)?;
        *channel = (0.0..=most).contains(&number).then_some(number).ok_or(expected)?;
        count += 1;
    }
    match count {
        1 => Ok(Rgb::splat(channels[0])),
        3 => Ok(Rgb::from_array(channels)),
        _ => Err(expected),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn properties_are_read_and_the_rest_is_passed_over() {
        let text = b"Kd 1 1 1\nnewmtl clear glass #2\r\n Kd 0.1 0.2 0.3 # note\nKs 0.5\nTf 0.9 0.8 0.7\n\
                     Ns 200\nNi 1.52\nTr 0.25\nillum 7\nPr 0.3\naniso 1\nnewmtl b\nTr 0.5\nd -halo 0.75\nKe 20 0 0";
        let (materials, warnings) = parse("x.mtl", text);
        assert_eq!(warnings, Vec::<String>::new());
        let expected = MtlMaterial {
            name: "clear glass #2".into(),
            is_defined: true,
            kd: Some(Rgb::new(0.1, 0.2, 0.3)),
            ks: Some(Rgb::splat(0.5)),
            ke: None,
            tf: Some(Rgb::new(0.9, 0.8, 0.7)),
            ns: Some(200.0),
            ni: Some(1.52),
            d: Some(0.75),
            illum: Some(7),
            map_kd: None,
        };
        assert_eq!(materials[0], expected);
        assert_eq!((materials[1].d, materials[1].ke), (Some(0.75), Some(Rgb::new(20.0, 0.0, 0.0))));
        assert_eq!(materials.len(), 2);
    }

    #[test]
    fn nonsense_is_said_once_with_its_line() {
        let text = b"newmtl a\nKd 1 2\nKd\nKd spectral a.rfl\nKs nan 0 0\nKd 3\nNi 0\nd 2\nillum glass\n\
                     map_Ks a.png\nmap_Kd -s 2\nKd 0.5 0.5 0.5";
        let (materials, warnings) = parse("x.mtl", text);
        assert_eq!(materials[0].kd, Some(Rgb::splat(0.5)));
        assert_eq!((materials[0].ni, materials[0].d, materials[0].illum), (None, None, None));
        assert_eq!(warnings.len(), 2);
        assert!(warnings[0].contains("passed over: 9 (first at line 2, Kd: found `1 2`, expected"));
        assert!(warnings[1].contains("texture maps not used: 1"));
    }

    #[test]
    fn maps_of_the_colour_are_read_with_what_places_them() {
        let map = |text: &str| {
            let (materials, warnings) = parse("sub/x.mtl", format!("newmtl a\nmap_Kd {text}").as_bytes());
            assert_eq!(warnings, Vec::<String>::new(), "{text}");
            materials[0].map_kd.clone().expect("a map")
        };
        let (scale, offset) = (DVec2::ONE, DVec2::ZERO);
        let plain = MtlMap { file: "sub/old wood.png".into(), scale, offset, clamp: false };
        assert_eq!(map("old wood.png"), plain);
        assert_eq!(map("-blendu on -mm 0 1 -bm 0.5 -t 1 1 1 old wood.png"), plain);
        let placed =
            MtlMap { scale: DVec2::new(2.0, 3.0), offset: DVec2::new(0.5, 0.0), clamp: true, ..plain };
        assert_eq!(map("-s 2 3 1 -o 0.5 -clamp on old wood.png"), placed);
        assert_eq!(map("-name.png").file, "sub/-name.png");
        let (materials, warnings) = parse("x.mtl", b"newmtl a\nmap_Kd -s 0 a.png");
        assert!(materials[0].map_kd.is_none() && warnings[0].contains("the name of an image file"));
    }
}
