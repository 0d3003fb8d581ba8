//! Files and names that the code of a file uses.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{ImplItem, Item};

use super::modules::{ModulePath, Modules, Target, attributes, attributes_within, is_test, joined};

/// Files, and the names that are taken from each.
pub type Uses = BTreeMap<usize, BTreeSet<String>>;

/// The files that declare what `items` of the module at `path` use, as far as paths tell: a call of a method is not seen.
pub fn uses(modules: &Modules, path: &[String], items: &[Item]) -> Uses {
    let mut finder = Finder {
        modules,
        module: path.to_vec(),
        files: Uses::new(),
    };
    finder.imports();
    for item in items {
        finder.visit_item(item);
    }
    finder.files
}

struct Finder<'a> {
    modules: &'a Modules,
    module: ModulePath,
    files: Uses,
}

impl Finder<'_> {
    fn imports(&mut self) {
        let modules = self.modules;
        let module = self.module.clone();
        for path in modules.private_imports(&module) {
            self.path(path);
        }
    }

    fn path(&mut self, path: &[String]) {
        if let Some(Target::Item(file)) = self.modules.resolve(&self.module, path) {
            let names = self.files.entry(file).or_default();
            names.extend(path.last().cloned());
        }
    }

    /// Paths in the arguments of a macro, whatever its syntax.
    fn tokens(&mut self, tokens: TokenStream) {
        let (mut path, mut colons) = (vec![], 0);
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => {
                    if colons != 2 {
                        self.path(&std::mem::take(&mut path));
                    }
                    path.push(ident.to_string());
                    colons = 0;
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                other => {
                    self.path(&std::mem::take(&mut path));
                    colons = 0;
                    if let TokenTree::Group(group) = other {
                        self.tokens(group.stream());
                    }
                }
            }
        }
        self.path(&path);
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        if is_test(attributes(item)) {
            return;
        }
        match item {
            // Imports are looked up with the module.
            Item::Use(_) => {}
            Item::Mod(inner) => {
                if inner.content.is_some() {
                    let inner = joined(&self.module, &inner.ident.to_string());
                    let outer = std::mem::replace(&mut self.module, inner);
                    self.imports();
                    visit::visit_item(self, item);
                    self.module = outer;
                }
            }
            _ => visit::visit_item(self, item),
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        if !is_test(attributes_within(item)) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if path.leading_colon.is_none() {
            let segments = path.segments.iter();
            let names: Vec<_> = segments.map(|segment| segment.ident.to_string()).collect();
            self.path(&names);
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        visit::visit_macro(self, call);
        self.tokens(call.tokens.clone());
    }
}
