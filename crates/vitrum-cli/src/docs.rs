//! Holds the page of the program (`docs/cli.md`) to the program's own help.

use crate::args::Arguments;
use clap::CommandFactory;
use std::path::Path;

/// The page with the help of each command between its markers.
fn renewed(page: &str) -> String {
    let mut root = Arguments::command().term_width(100);
    let mut renewed = String::new();
    let mut rest = page;
    while let Some(start) = rest.find("<!-- help: ") {
        let name = rest[start + 11..].split(' ').next().expect("a split has a first part");
        let opened = start + rest[start..].find('\n').expect("the marker ends its line") + 1;
        let end = opened + rest[opened..].find("<!-- end -->").expect("every help has its end");
        let command = root.find_subcommand_mut(name).expect("the page names commands of the program");
        let help =
            command.clone().bin_name(format!("vitrum {name}")).term_width(100).render_help().to_string();
        let help: String = help.lines().map(|line| format!("{}\n", line.trim_end())).collect();
        renewed += &format!("{}\n```text\n{help}```\n\n<!-- end -->", &rest[..opened]);
        rest = &rest[end + "<!-- end -->".len()..];
    }
    renewed + rest
}

#[test]
fn the_page_is_the_programs_own_help() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/cli.md");
    let page = std::fs::read_to_string(&path).expect("the page is part of the repository");
    let expected = renewed(&page);
    if vitrum_testkit::blessing() {
        std::fs::write(&path, &expected).expect("the page can be written");
    }
    assert!(
        page == expected || vitrum_testkit::blessing(),
        "docs/cli.md is out of date: VITRUM_BLESS=1 renews it"
    );
}
