"use strict";
// Search in the pages of the site, without a network. `sections` comes from script/search_index: a
// list of [page, title, url, text].

const stopwords = new Set(("a an and are as at be by can do does for from has have how i in is it its my of on or " +
    "so that the there this to what when where which why with without").split(" "));
// A word by its first six letters without a plural: "stability" finds "stable", "joints" "joint".
const root = (word) => word.replace(/(?<=...)s$/, "").slice(0, 6);
const words_of = (text) => (text.toLowerCase().match(/[a-z0-9]+/g) || []).map(root);

class Index {
  constructor(sections) {
    this.sections = sections.map(([page, title, url, text]) => {
      const counts = new Map();
      const add = (part, weight) => words_of(part).forEach(
          (word) => counts.set(word, (counts.get(word) || 0) + weight));
      add(page, 2);
      add(title, 6);
      add(text, 1);
      return { page, title, url, text, counts, length: words_of(text).length + 8 };
    });
    this.mean = this.sections.reduce((sum, { length }) => sum + length, 0) / this.sections.length;
  }
  // How much a word tells: little if many sections have it.
  weight(word) {
    const with_word = this.sections.filter(({ counts }) => counts.has(word)).length;
    return Math.log(1 + (this.sections.length - with_word + 0.5) / (with_word + 0.5));
  }
  // The best sections first, by BM25 (Robertson, Walker 1994; k = 1.2, b = 0.75).
  find(query, most = 8) {
    const words = [...new Set((query.toLowerCase().match(/[a-z0-9]+/g) || [])
        .filter((word) => !stopwords.has(word)).map(root))];
    const weights = words.map((word) => this.weight(word));
    const score = ({ counts, length }) => words.reduce((sum, word, i) => {
      const count = counts.get(word) || 0;
      return sum + weights[i] * count * 2.2 / (count + 1.2 * (0.25 + 0.75 * length / this.mean));
    }, 0);
    const of_page = new Map();  // at most two sections of a page are shown
    return this.sections.map((section) => ({ section, score: score(section) }))
        .filter((found) => found.score > 0).sort((a, b) => b.score - a.score)
        .filter(({ section: { page } }) => of_page.set(page, (of_page.get(page) || 0) + 1).get(page) <= 2)
        .slice(0, most);
  }
}

// About 200 letters of a text around the first word of the query.
function excerpt(text, query) {
  const wanted = new Set(words_of(query));
  const at = [...text.matchAll(/[A-Za-z0-9]+/g)].find(([word]) => wanted.has(root(word.toLowerCase())));
  const about = Math.max(0, (at ? at.index : 0) - 60);
  const begin = about > 0 ? text.indexOf(" ", about) + 1 : 0;
  const part = text.slice(begin, begin + 200);
  return `${begin > 0 ? "... " : ""}${part}${begin + 200 < text.length ? " ..." : ""}`;
}
