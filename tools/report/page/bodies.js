// A button for each body: a click hides or shows it, a double click shows it alone, or all again.

class BodyList {
  // numbers: of the bodies that have particles; changed: called when another choice is shown
  constructor(numbers, changed) {
    this.numbers = numbers;
    this.changed = changed;
    this.hidden = new Set();
    this.buttons = numbers.map(number => element('button', {value: number, onclick: () => this.toggle(number), ondblclick: () => this.alone(number),
      title: 'click: hide or show; double click: this body alone, or all'}, bodyName(number)));
    this.root = element('div', {class: 'legend bodies', id: 'bodies', hidden: numbers.length < 2}, element('span', {}, 'bodies'), ...this.buttons);
    this.show();
  }

  shows(number) { return !this.hidden.has(number); }

  toggle(number) {
    if (!this.hidden.delete(number)) this.hidden.add(number);
    this.show();
  }

  // The two clicks of a double click have hidden and shown it.
  alone(number) {
    const others = this.numbers.filter(other => other !== number), isAlone = others.every(other => this.hidden.has(other));
    this.hidden = new Set(isAlone ? [] : others);
    this.show();
  }

  show() {
    this.buttons.forEach((button, k) => {
      const shown = this.shows(this.numbers[k]);
      button.classList.toggle('off', !shown);
      button.setAttribute('aria-pressed', shown);
    });
    this.changed();
  }
}
