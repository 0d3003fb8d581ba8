//! The modules of one crate, and what the names in them stand for.

use std::collections::{BTreeMap, BTreeSet};

use syn::{Attribute, ImplItem, Item, UseTree, Visibility};

/// Names from the root of the crate down; empty for the root.
pub type ModulePath = Vec<String>;

/// A name brought into a module by `use`; `*` for all of a module's.
struct Import {
    name: String,
    path: Vec<String>,
    private: bool,
}

#[derive(Default)]
struct Module {
    /// Index of its file.
    file: usize,
    /// Names of what is declared in it, modules excepted.
    items: BTreeSet<String>,
    imports: Vec<Import>,
}

/// Names that were looked up on the way, so that modules that import all of each other end.
type Asked = BTreeSet<(ModulePath, bool)>;

/// A crate's modules by their paths.
#[derive(Default)]
pub struct Modules(BTreeMap<ModulePath, Module>);

/// The module or item that a path names.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    Module(ModulePath),
    /// Index of the file that declares the item.
    Item(usize),
}

/// True for what is compiled in tests only.
pub fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let test = attribute.parse_args::<syn::Ident>();
        attribute.path().is_ident("cfg") && test.is_ok_and(|word| word == "test")
    })
}

/// The attributes of any item that may have some.
pub fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(i) => &i.attrs,
        Item::Enum(i) => &i.attrs,
        Item::Fn(i) => &i.attrs,
        Item::Impl(i) => &i.attrs,
        Item::Macro(i) => &i.attrs,
        Item::Mod(i) => &i.attrs,
        Item::Static(i) => &i.attrs,
        Item::Struct(i) => &i.attrs,
        Item::Trait(i) => &i.attrs,
        Item::Type(i) => &i.attrs,
        Item::Use(i) => &i.attrs,
        _ => &[],
    }
}

/// The same of what stands in an `impl`.
pub fn attributes_within(item: &ImplItem) -> &[Attribute] {
    match item {
        ImplItem::Const(i) => &i.attrs,
        ImplItem::Fn(i) => &i.attrs,
        ImplItem::Type(i) => &i.attrs,
        _ => &[],
    }
}

impl Modules {
    /// Adds the module at `path`, whose items stand in `file`, and the modules written out in it.
    pub fn add(&mut self, path: &[String], file: usize, items: &[Item]) {
        let mut module = Module {
            file,
            ..Module::default()
        };
        for item in items.iter().filter(|item| !is_test(attributes(item))) {
            let name = match item {
                Item::Const(i) => &i.ident,
                Item::Enum(i) => &i.ident,
                Item::Fn(i) => &i.sig.ident,
                Item::Static(i) => &i.ident,
                Item::Struct(i) => &i.ident,
                Item::Trait(i) => &i.ident,
                Item::Type(i) => &i.ident,
                Item::Union(i) => &i.ident,
                Item::Macro(i) => match &i.ident {
                    Some(ident) => ident,
                    None => continue,
                },
                Item::Mod(i) => {
                    if let Some((_, items)) = &i.content {
                        self.add(&joined(path, &i.ident.to_string()), file, items);
                    }
                    continue;
                }
                Item::Use(i) => {
                    let private = matches!(i.vis, Visibility::Inherited);
                    import(&i.tree, &mut vec![], private, &mut module.imports);
                    continue;
                }
                _ => continue,
            };
            module.items.insert(name.to_string());
        }
        self.0.insert(path.to_vec(), module);
    }

    /// The paths that the module at `path` brings in for itself alone, `*` excepted.
    pub fn private_imports(&self, path: &[String]) -> impl Iterator<Item = &[String]> {
        let imports = self.0[path].imports.iter();
        let imports = imports.filter(|import| import.private && import.name != "*");
        imports.map(|import| &import.path[..])
    }

    /// Target of `path`, written in module `from`; `None` for another crate's and for what is declared in a function.
    pub fn resolve(&self, from: &[String], path: &[String]) -> Option<Target> {
        self.follow(from, path, false, &mut Asked::new())
    }

    /// The same, where `more` names follow the path.
    fn follow(
        &self,
        from: &[String],
        path: &[String],
        more: bool,
        asked: &mut Asked,
    ) -> Option<Target> {
        let (mut at, mut rest) = (from.to_vec(), path);
        while let [first, next @ ..] = rest {
            match first.as_str() {
                "crate" => at.clear(),
                "super" => drop(at.pop()),
                "self" => {}
                _ => break,
            }
            rest = next;
        }
        let mut target = Target::Module(at);
        while let ([name, next @ ..], Target::Module(module)) = (rest, &target) {
            target = self.member(module, name, more || !next.is_empty(), asked)?;
            rest = next;
        }
        Some(target)
    }

    /// Target of `name` in `module`. A module and an item may share it: the module is meant where more follows.
    fn member(
        &self,
        module: &[String],
        name: &str,
        more: bool,
        asked: &mut Asked,
    ) -> Option<Target> {
        let here = self.0.get(module)?;
        let child = joined(module, name);
        if !asked.insert((child.clone(), more)) {
            return None;
        }
        let child = (self.0.contains_key(&child)).then_some(Target::Module(child));
        let item = (here.items.contains(name)).then_some(Target::Item(here.file));
        if let Some(found) = if more { child.clone().or(item) } else { item } {
            return Some(found);
        }
        let mut named = here.imports.iter().filter(|import| import.name == name);
        let imported = named.find_map(|import| self.imported(module, &import.path, more, asked));
        if let Some(found) = imported.or(child) {
            return Some(found);
        }
        let mut all = here.imports.iter().filter(|import| import.name == "*");
        all.find_map(
            |import| match self.follow(module, &import.path, true, asked)? {
                Target::Module(parent) => self.member(&parent, name, more, asked),
                item => Some(item),
            },
        )
    }

    fn imported(
        &self,
        module: &[String],
        path: &[String],
        more: bool,
        asked: &mut Asked,
    ) -> Option<Target> {
        let (last, parent) = path.split_last()?;
        if matches!(last.as_str(), "crate" | "self" | "super") {
            return self.follow(module, path, more, asked);
        }
        match self.follow(module, parent, true, asked)? {
            Target::Module(parent) => self.member(&parent, last, more, asked),
            item => Some(item),
        }
    }
}

fn import(tree: &UseTree, path: &mut Vec<String>, private: bool, imports: &mut Vec<Import>) {
    let mut add = |name: String, last: Option<String>| {
        let path = path.iter().cloned().chain(last).collect();
        imports.push(Import {
            name,
            path,
            private,
        });
    };
    match tree {
        UseTree::Path(part) => {
            path.push(part.ident.to_string());
            import(&part.tree, path, private, imports);
            path.pop();
        }
        UseTree::Name(name) if name.ident == "self" => {
            add(path.last().cloned().unwrap_or_default(), None);
        }
        UseTree::Name(name) => add(name.ident.to_string(), Some(name.ident.to_string())),
        UseTree::Rename(name) if name.ident == "self" => add(name.rename.to_string(), None),
        UseTree::Rename(name) => add(name.rename.to_string(), Some(name.ident.to_string())),
        UseTree::Glob(_) => add("*".to_owned(), None),
        UseTree::Group(group) => {
            for tree in &group.items {
                import(tree, path, private, imports);
            }
        }
    }
}

pub fn joined(path: &[String], name: &str) -> ModulePath {
    path.iter().cloned().chain([name.to_owned()]).collect()
}
