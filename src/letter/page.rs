//! The letter and the results as one page of HTML, and other results with one picture and a table.
//! Styles and pictures are part of it; nothing is loaded and no script is run. The only file that
//! imports maud.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{Claim, Figure, Reproduction, Verdict};

/// The generator named in the head of the page.
pub(crate) const GENERATOR: &str = "slipmap reproduce";

/// That of a comparison of methods of control.
pub(crate) const GENERATOR_OF_COMPARE: &str = "slipmap compare";

const STYLE: &str = include_str!("page.css");

impl Reproduction {
    /// The page. `made`: the program and time, in one line; `quick`: whether maps are coarser.
    #[must_use]
    pub(crate) fn page(&self, made: &str, quick: bool) -> String {
        let verdicts = [Verdict::Confirmed, Verdict::Refined, Verdict::Contradicted];
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="generator" content=(GENERATOR);
                    meta name="color-scheme" content="light dark";
                    title { "Controlling friction, reproduced" }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    header {
                        h1 { "Controlling friction, reproduced" }
                        p {
                            "Every claim of F.-J. Elmer, " cite { "Controlling friction" }
                            " (1997), computed again. Each verdict follows from the numbers of \
                              this run."
                        }
                        p.made { (made) @if quick { "; a quick run, from coarser maps" } }
                        p.counts {
                            @for verdict in verdicts {
                                (badge(verdict)) " " (self.with(verdict)) " "
                            }
                        }
                    }
                    main {
                        (self.contents())
                        @for claim in &self.claims { (self.claim(claim)) }
                    }
                }
            }
        };
        page.into_string()
    }

    /// All claims in a table, each with its most telling value.
    fn contents(&self) -> Markup {
        html! {
            h2 { "Claims" }
            table {
                thead { tr { th { "claim" } th { "found" } th { "verdict" } } }
                tbody {
                    @for claim in &self.claims {
                        tr {
                            td {
                                a href={ "#" (claim.name) } { "“" (claim.quotation) "”" }
                                small { (claim.place) }
                            }
                            td {
                                @if let Some(value) = claim.values.first() {
                                    small { (value.name) } " " span.number { (value.shown()) }
                                }
                            }
                            td { (badge(claim.verdict)) }
                        }
                    }
                }
            }
        }
    }

    fn claim(&self, claim: &Claim) -> Markup {
        html! {
            section #(claim.name) {
                h2 { "“" (claim.quotation) "”" }
                p.place { (claim.place) " " (badge(claim.verdict)) }
                p { (claim.because) }
                div.values {
                    table {
                        thead {
                            tr {
                                th { "value" } th { "found" } th { "the letter" }
                                th { "what it is" }
                            }
                        }
                        tbody {
                            @for value in &claim.values {
                                tr {
                                    td { (value.name) }
                                    td.number { (value.shown()) }
                                    td.number {
                                        @if let Some(number) = value.letter {
                                            "the letter: " (number)
                                        }
                                    }
                                    td { (value.meaning) }
                                }
                            }
                        }
                    }
                }
                p { b { "How " } (claim.how) }
                @if !claim.commands.is_empty() {
                    p { b { "Again " } }
                    pre { @for command in &claim.commands { code { (command) "\n" } } }
                }
                @if !claim.evidence.is_empty() {
                    p {
                        b { "Behind it " }
                        @for name in &claim.evidence { a href={ "#figure-" (name) } { (name) } " " }
                    }
                }
                @for figure in &self.figures {
                    @if self.home(figure) == claim.name { (self.figure(figure)) }
                }
            }
        }
    }

    /// The claim under which a figure is shown: the one that rests on it most.
    fn home(&self, figure: &Figure) -> &'static str {
        let first = |claim: &&Claim| claim.evidence.first() == Some(&figure.name);
        let any = |claim: &&Claim| claim.evidence.contains(&figure.name);
        let home = self.claims.iter().find(first);
        let home = home.or_else(|| self.claims.iter().find(any));
        home.map_or("", |claim| claim.name)
    }

    fn figure(&self, figure: &Figure) -> Markup {
        html! {
            figure #{ "figure-" (figure.name) } {
                div.picture role="group" tabindex="0" aria-label=(figure.title) {
                    (PreEscaped(&figure.svg))
                }
                figcaption {
                    b { (figure.name) } " " (figure.title) ". Behind "
                    @for claim in &self.claims {
                        @if claim.evidence.contains(&figure.name) {
                            a href={ "#" (claim.name) } { (claim.name) } " "
                        }
                    }
                    pre { code { (figure.command) } }
                    details {
                        summary {
                            @if figure.shipped { "the file" } @else { "the file, as it was run" }
                        }
                        pre { code { (figure.source) } }
                    }
                    @if let Some(file) = &figure.file { p { code { (file) } } }
                }
            }
        }
    }
}

/// A page of one result.
pub(crate) struct Sheet<'a> {
    /// The generator named in its head.
    pub generator: &'a str,
    /// The title.
    pub title: &'a str,
    /// What is shown, in paragraphs.
    pub text: &'a [String],
    /// The program and the command, in one line each.
    pub made: &'a [String],
    /// The picture, if there is one.
    pub svg: Option<&'a str>,
    /// The names of columns, and rows.
    pub head: &'a [String],
    /// As many texts as there are columns.
    pub rows: &'a [Vec<String>],
}

impl Sheet<'_> {
    /// The page.
    #[must_use]
    pub(crate) fn page(&self) -> String {
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="generator" content=(self.generator);
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    header {
                        h1 { (self.title) }
                        @for text in self.text { p { (text) } }
                        @for made in self.made { p.made { (made) } }
                    }
                    main {
                        @if let Some(svg) = self.svg {
                            figure {
                                div.picture role="group" tabindex="0" aria-label=(self.title) {
                                    (PreEscaped(svg))
                                }
                            }
                        }
                        div.sheet tabindex="0" role="group" aria-label="the numbers" {
                            table {
                                thead {
                                    tr { @for name in self.head { th scope="col" { (name) } } }
                                }
                                tbody {
                                    @for row in self.rows {
                                        tr { @for text in row { td.number { (text) } } }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        };
        page.into_string()
    }
}

fn badge(verdict: Verdict) -> Markup {
    html! { span class={ "verdict " (verdict.name()) } { (verdict.name()) } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::letter::Verdict;
    use crate::letter::claim::ClaimValue;

    fn found() -> Reproduction {
        let at = ("Fig. 0", "a < b & so on");
        let claim = Claim::new("name", at, Verdict::Refined, "because".into(), "how")
            .by([ClaimValue::of("b_star", "a slope", -0.72).beside(-0.68)])
            .from(&["map"]);
        let figure = Figure {
            name: "map",
            title: "A map".into(),
            command: "slipmap run map.toml".into(),
            source: "title = \"<script>\"".into(),
            shipped: false,
            file: None,
            svg: "<svg></svg>".into(),
        };
        Reproduction {
            claims: vec![claim],
            figures: vec![figure],
        }
    }

    #[test]
    fn a_page_holds_its_claims_and_what_is_behind_them() {
        let page = found().page("slipmap, now", true);
        for part in [
            "a &lt; b &amp; so on",
            "-0.68",
            "-0.72",
            "id=\"name\"",
            "id=\"figure-map\"",
            "href=\"#figure-map\"",
            "&lt;script&gt;",
            "<svg></svg>",
            "class=\"verdict refined\"",
            "a quick run",
        ] {
            assert!(page.contains(part), "{part} is in {page}");
        }
        assert!(!page.contains("<script"));
        assert!(!found().page("slipmap, now", false).contains("a quick run"));
    }
}
