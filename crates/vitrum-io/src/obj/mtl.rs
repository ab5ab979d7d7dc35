//! Reads an MTL material library.
//!
//! `Kd`, `Ks`, `Ke`, `Tf` (one number or three), `Ns`, `Ni`, `d`, `Tr` and `illum` are read; texture maps are counted;
//! everything else is passed over. A statement that makes no sense is passed over as well and said, with its line: a
//! library is never a reason to refuse a model. (The OBJ library's own reader is not used here: it stops at the first
//! such line, panics at `Kd 1`, and does not know `Tf` and `Tr`.)

use vitrum_math::Rgb;

use super::MtlMaterial;
use super::lines;

/// The materials of a library in file order, and what there is to say about it. `name` is for messages.
pub(super) fn parse(name: &str, bytes: &[u8]) -> (Vec<MtlMaterial>, Vec<String>) {
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
        maps += u64::from(keyword.starts_with(b"map_") || keyword == b"bump");
        if let Err(expected) = set(material, keyword, rest) {
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
fn set(material: &mut MtlMaterial, keyword: &[u8], rest: &[u8]) -> Result<(), &'static str> {
    match keyword {
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
        };
        assert_eq!(materials[0], expected);
        assert_eq!((materials[1].d, materials[1].ke), (Some(0.75), Some(Rgb::new(20.0, 0.0, 0.0))));
        assert_eq!(materials.len(), 2);
    }

    #[test]
    fn nonsense_is_said_once_with_its_line() {
        let text = b"newmtl a\nKd 1 2\nKd\nKd spectral a.rfl\nKs nan 0 0\nKd 3\nNi 0\nd 2\nillum glass\n\
                     map_Kd a.png\nKd 0.5 0.5 0.5";
        let (materials, warnings) = parse("x.mtl", text);
        assert_eq!(materials[0].kd, Some(Rgb::splat(0.5)));
        assert_eq!((materials[0].ni, materials[0].d, materials[0].illum), (None, None, None));
        assert_eq!(warnings.len(), 2);
        assert!(warnings[0].contains("passed over: 8 (first at line 2, Kd: found `1 2`, expected"));
        assert!(warnings[1].contains("texture maps not used: 1"));
    }
}
