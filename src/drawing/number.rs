//! Numbers as people write them.

/// `value` with so many significant digits at most, no zeros at the end; 4·10⁻⁷ where it is very large or small.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    let scientific = format!("{value:.*e}", digits.max(1) - 1);
    let Some((mantissa, exponent)) = scientific.split_once('e') else { return scientific };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..6).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return trimmed(&fixed(value, decimals)).to_owned();
    }
    let mantissa = trimmed(mantissa).replace('-', "−");
    let power = format!("10{}", superscript(exponent));
    match mantissa.as_str() {
        "1" => power,
        "−1" => format!("−{power}"),
        _ => format!("{mantissa}·{power}"),
    }
}

/// `value` with so many decimals.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let zero = !text.contains(|c: char| c.is_ascii_digit() && c != '0');
    if zero { text.replace('-', "") } else { text.replace('-', "−") }
}

/// As [`fixed`], with a sign always.
pub(super) fn signed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    if text.starts_with('−') { text } else { format!("+{text}") }
}

/// Without zeros at the end of decimals.
pub(super) fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

pub(crate) fn superscript(exponent: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + (digit as u32 - '0' as u32)).unwrap_or(digit),
    };
    exponent.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        for (value, text) in [
            (2.294157, "2.294"),
            (1.0, "1"),
            (0.0, "0"),
            (-0.0, "0"),
            (-3.25, "−3.25"),
            (0.00123456, "0.001235"),
            (99999.6, "100000"),
            (1e9, "10⁹"),
            (-1e9, "−10⁹"),
            (2.5e-7, "2.5·10⁻⁷"),
            (6.02214e23, "6.022·10²³"),
        ] {
            assert_eq!(significant(value, 4), text);
        }
        assert_eq!(fixed(-0.001, 2), "0.00");
        assert_eq!(fixed(-1.5, 3), "−1.500");
        assert_eq!(signed(1.5, 2), "+1.50");
        assert_eq!(signed(-1.5, 2), "−1.50");
    }
}
